// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Catch2 2 wants its main() compiled in one place; version 3 brings a library for it.
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>
