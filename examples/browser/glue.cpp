// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// spectral_simplify for worker.js: arguments come as words, files are those of Emscripten.

#include "../programs/io/Progress_bar.h"
#include "../programs/io/input_mesh.h"
#include "../programs/io/program.h"
#include "../programs/spectral_simplify_arguments.h"

#include <emscripten/bind.h>
#include <emscripten/val.h>

#include <string>

using emscripten::val;

namespace {

// A name or a word; as the program has it where the page leaves it out.
void take(const val& fields, const char* name, std::string& value)
{
  if(fields.hasOwnProperty(name))
    value = fields[name].as<std::string>();
}

// Reads a mesh, so that the page can say how large it is: its number of vertices, or 0 where it
// complains on standard error.
double number_of_vertices(const std::string& path, const bool repair)
{
  double n = 0;
  run_program("spectral_simplify", [&] {
    n = double(num_vertices(read_input_mesh(path, mending(false, repair)).mesh));
    return 0;
  });
  return n;
}

// Runs the program and returns its exit status; `progress` is called with a phase and a fraction.
int simplify(const val& fields, const val& progress)
{
  progress_listener = [&progress](const std::string& phase, const double fraction) {
    progress(phase, fraction);
  };
  const int status = run_program("spectral_simplify", [&] {
    Arguments a;
    a.threads = 1;
    take(fields, "command", a.command);
    take(fields, "input", a.input);
    take(fields, "output", a.output);
    take(fields, "vertices", a.vertices_word);
    take(fields, "preset", a.preset);
    take(fields, "restriction", a.restriction);
    take(fields, "json", a.json);
    take(fields, "report", a.report);
    a.eigenvectors = fields["eigenvectors"].as<long>();
    a.repair = fields["repair"].as<bool>();
    a.no_evaluation = fields["noEvaluation"].as<bool>();
    return run(understood(a));
  });
  progress_listener = nullptr;
  return status;
}

} // namespace

EMSCRIPTEN_BINDINGS(spectral_simplify)
{
  emscripten::function("numberOfVertices", &number_of_vertices);
  emscripten::function("simplify", &simplify);
}
