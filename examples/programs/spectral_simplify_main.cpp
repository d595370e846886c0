// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Simplifies a mesh from the command line; --help shows the options.

#include "io/program.h"
#include "spectral_simplify_command_line.h"

#include <iostream>

int main(int argc, char* argv[])
{
  return run_program("spectral_simplify", [&] {
    const Arguments arguments = parse_arguments(argc, argv);
    if(arguments.help.empty())
      return run(arguments);
    std::cout << arguments.help;
    return 0;
  });
}
