// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_COMMAND_LINE_H
#define SPECTRAL_EXAMPLES_IO_COMMAND_LINE_H

#include <boost/program_options.hpp>

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

// What the programs do alike with their command lines.

// As it was typed.
inline std::string command_line(const char* program, const int argc, const char* const* argv)
{
  std::string command = program;
  for(int k = 1; k < argc; ++k)
    command += std::string(" ") + argv[k];
  return command;
}

// An argument without a name, and where it goes; null if it is among the options, too.
using Positional_argument = std::pair<const char*, std::string*>;

// Stores all options and arguments, and returns the text that --help asks for, or nothing. No abbreviations: what --mass means must
// not depend on what else there is. No short options: a negative number is a value. Throws std::runtime_error with one
// sentence; `arguments` names in it what may stand without a name.
inline std::string read_command_line(const int argc, const char* const* argv,
                                     const boost::program_options::options_description& options,
                                     const std::vector<Positional_argument>& positional,
                                     const std::string& arguments,
                                     boost::program_options::variables_map& values)
{
  namespace po = boost::program_options;
  po::options_description all;
  all.add(options);
  po::positional_options_description positions;
  for(const Positional_argument& p : positional) {
    if(p.second != nullptr)
      all.add_options()(p.first, po::value(p.second));
    positions.add(p.first, 1);
  }
  const int style = po::command_line_style::unix_style & ~po::command_line_style::allow_short &
                    ~po::command_line_style::allow_guessing;
  try {
    po::store(po::command_line_parser(argc, argv).options(all).positional(positions).style(style).run(),
              values);
    po::notify(values);
  } catch(const po::too_many_positional_options_error&) {
    throw std::runtime_error("there are more arguments than " + arguments + "; --help shows everything.");
  } catch(const po::error& error) {
    throw std::runtime_error(std::string(error.what()) + "; --help shows everything.");
  }
  std::ostringstream text;
  if(values.count("help"))
    text << options;
  return text.str();
}

// Refuses a value that is none of `choices`. Nothing is no choice, and passes.
inline void check_choice(const char* option, const std::string& value,
                         const std::vector<std::string>& choices)
{
  if(value.empty() || std::find(choices.begin(), choices.end(), value) != choices.end())
    return;
  std::string list = choices.front();
  for(std::size_t i = 1; i < choices.size(); ++i)
    list += (i + 1 < choices.size() ? ", " : " or ") + choices[i];
  throw std::runtime_error(std::string(option) + " is '" + value + "', it must be " + list + ".");
}

#endif // SPECTRAL_EXAMPLES_IO_COMMAND_LINE_H
