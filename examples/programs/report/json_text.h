// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_REPORT_JSON_TEXT_H
#define SPECTRAL_EXAMPLES_REPORT_JSON_TEXT_H

#include <nlohmann/json.hpp>

#include <cmath>
#include <string>

// Numbers that were not computed are null.
inline nlohmann::json number_json(const double x)
{
  return std::isfinite(x) ? nlohmann::json(x) : nlohmann::json();
}

// The text of a JSON file. Names of files need not be UTF-8, JSON must be: what is not becomes
// U+FFFD.
inline std::string json_text(const nlohmann::json& json, const int indent)
{
  return json.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

#endif // SPECTRAL_EXAMPLES_REPORT_JSON_TEXT_H
