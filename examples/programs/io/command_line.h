// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_COMMAND_LINE_H
#define SPECTRAL_EXAMPLES_IO_COMMAND_LINE_H

#include "text_lines.h"

#include <boost/program_options.hpp>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

// What the programs do alike with their command lines.

// As it could be typed again.
inline std::string command_line(const char* program, const int argc, const char* const* argv)
{
  std::string command = program;
  for(int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    const bool plain =
        !word.empty() &&
        word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                               "_./=,%+:@-") == std::string::npos;
    command += ' ';
    if(plain) {
      command += word;
      continue;
    }
    command += '\'';
    for(const char c : word)
      command += c == '\'' ? std::string("'\\''") : std::string(1, c);
    command += '\'';
  }
  return command;
}

// NAME and files of NAME=FILE,..., at least and at most so many; `form` says in an error what it
// must be.
inline std::vector<std::string> named_files(const std::string& option, const std::string& text,
                                            const std::string& form, std::size_t least,
                                            std::size_t most)
{
  const std::size_t equals = text.find('=');
  std::vector<std::string> parts{text.substr(0, equals)};
  if(equals != std::string::npos) {
    std::istringstream files(text.substr(equals + 1) + ",");
    for(std::string file; std::getline(files, file, ',');)
      parts.push_back(file);
  }
  if(std::find(parts.begin(), parts.end(), "") != parts.end() || parts.size() < 1 + least ||
     parts.size() > 1 + most)
    throw std::runtime_error(option + " is '" + text + "', it must be " + form + ".");
  return parts;
}

// The arguments and options of a program, options in groups. One table is what is read, what --help
// says and what doc/commands.md shows.
class Command_line
{
  using Options = boost::program_options::options_description;

public:
  // `usage`: what to type, a line for each form; `about`: what the program does.
  Command_line(std::string usage, std::string about)
    : m_usage(std::move(usage))
    , m_about(std::move(about))
  {}

  // The next argument without a name.
  void argument(std::string& value) { m_arguments.push_back(&value); }

  // Begins a group of options; --help leaves out the advanced ones, which only --help advanced
  // shows.
  void group(const std::string& name) { m_groups.push_back({name, Options(name, 100, 60), false}); }
  void advanced_group(const std::string& name)
  {
    m_groups.push_back({name, Options(name, 100, 60), true});
  }

  // An option that is given or is not.
  void flag(const char* name, bool& value, const std::string& description)
  {
    put(name, boost::program_options::bool_switch(&value), description);
  }

  // An option with a value, `form` in the help. What `value` holds already is the default; none if
  // that is nothing.
  template <class Value>
  void option(const char* name, Value& value, const char* form, const std::string& description)
  {
    auto* semantic = boost::program_options::value(&value)->value_name(form);
    if constexpr(std::is_arithmetic_v<Value>)
      semantic->default_value(value);
    if constexpr(std::is_same_v<Value, std::string>) {
      if(!value.empty())
        semantic->default_value(value);
      semantic->notifier([name = std::string(name)](const std::string& given) {
        if(given.empty())
          throw std::runtime_error("--" + name +
                                   " has an empty value: say which, or leave it out.");
      });
    }
    put(name, semantic, description);
  }
  template <class Value>
  void option(const char* name, std::optional<Value>& value, const char* form,
              const std::string& description)
  {
    auto* semantic = boost::program_options::value<Value>()->value_name(form);
    put(name, semantic->notifier([&value](const Value& given) { value = given; }), description);
  }

  // An option with one of these words as its value.
  void choice(const char* name, std::string& value, const std::vector<std::string>& words,
              const std::string& description)
  {
    auto* semantic = boost::program_options::value(&value)->value_name(joined(words, "|"));
    if(!value.empty())
      semantic->default_value(value);
    semantic->notifier([name = std::string(name), words](const std::string& given) {
      if(std::find(words.begin(), words.end(), given) == words.end())
        throw std::runtime_error("--" + name + " is '" + given + "', it must be " +
                                 joined({words.begin(), words.end() - 1}, ", ") + " or " +
                                 words.back() + ".");
    });
    put(name, semantic, description);
  }

  // The options that several programs have, in the same words.
  void threads(int& value)
  {
    auto* semantic =
        boost::program_options::value(&value)->value_name("T")->default_value(value, "all");
    put("threads", semantic->notifier([](const int given) {
      if(given < 1)
        throw std::runtime_error("--threads is " + std::to_string(given) +
                                 ", it must be at least 1.");
    }),
        "all cores by default; the result does not depend on it");
  }
  void strict(bool& value)
  {
    flag("strict", value, "change nothing of a mesh: refuse what cannot be used as it is");
  }

  // Stores all arguments and options, and returns the text that --help, --help advanced or --help
  // markdown asks for, or nothing. No abbreviations: what --mass means must not depend on what else
  // there is. No short options: a negative number is a value. Throws std::runtime_error with one
  // sentence.
  std::string read(const int argc, const char* const* argv) const
  {
    namespace po = boost::program_options;
    for(int k = 1; k < argc; ++k) {
      const std::string word = argv[k];
      if(word == "--help" || word.rfind("--help=", 0) == 0) {
        const std::string which = word != "--help" ? word.substr(7)
                                  : k + 1 < argc   ? argv[k + 1]
                                                   : "";
        if(word != "--help" && which != "advanced" && which != "markdown")
          throw std::runtime_error("'" + word +
                                   "' is unknown: use --help, --help advanced or --help markdown.");
        return which == "markdown" ? markdown() : text(which == "advanced");
      }
    }
    Options all;
    for(const Group& group : m_groups)
      all.add(group.options);
    const int style = po::command_line_style::unix_style & ~po::command_line_style::allow_short &
                      ~po::command_line_style::allow_guessing;
    try {
      const po::parsed_options parsed =
          po::command_line_parser(argc, argv).options(all).style(style).run();
      std::size_t arguments = 0;
      for(const po::option& option : parsed.options)
        if(option.string_key.empty())
          for(const std::string& word : option.value)
            take_argument(word, arguments++);
      po::variables_map values;
      po::store(parsed, values);
      po::notify(values);
    } catch(const po::error& error) {
      throw std::runtime_error(std::string(error.what()) + "; " + all_options() +
                               " shows every option.");
    }
    return "";
  }

private:
  struct Group
  {
    std::string name;
    Options options;
    bool advanced;
  };

  void put(const char* name, const boost::program_options::value_semantic* semantic,
           const std::string& description)
  {
    m_groups.back().options.add_options()(name, semantic, description.c_str());
  }

  void take_argument(const std::string& word, const std::size_t number) const
  {
    if(word.size() > 1 && word[0] == '-')
      throw std::runtime_error("'" + word + "' is no option, options begin with two dashes; " +
                               all_options() + " shows every one.");
    if(number >= m_arguments.size())
      throw std::runtime_error("'" + word + "' is one argument too many; " + all_options() +
                               " shows every option.");
    *m_arguments[number] = word;
  }

  std::string all_options() const
  {
    const bool some =
        std::any_of(m_groups.begin(), m_groups.end(), [](const Group& g) { return g.advanced; });
    return some ? "--help advanced" : "--help";
  }

  std::string text(const bool advanced) const
  {
    Options shown(100, 60); // one for all groups: their columns agree
    for(const Group& group : m_groups)
      if(advanced || !group.advanced)
        shown.add(group.options);
    std::ostringstream stream;
    stream << m_usage << "\n\n" << m_about << "\n" << shown;
    if(!advanced && all_options() != "--help")
      stream << "\nThese are the common options; " << all_options() << " shows every one.\n";
    return stream.str();
  }

  static std::string table_cell(std::string text)
  {
    for(std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2)
      text.insert(at, "\\");
    return text;
  }

  // A section of doc/commands.md.
  std::string markdown() const
  {
    std::ostringstream stream;
    stream << "## " << m_usage.substr(0, m_usage.find(' ')) << "\n\n```\n"
           << m_usage << "\n```\n\n"
           << m_about << "\n";
    for(const Group& group : m_groups) {
      stream << "\n| " << group.name << " | |\n|---|---|\n";
      for(const auto& option : group.options.options()) {
        const std::string form = option->format_parameter();
        stream << "| `--" << option->long_name() << (form.empty() ? "" : " ") << table_cell(form)
               << "` | " << table_cell(option->description()) << " |\n";
      }
    }
    return stream.str();
  }

  std::string m_usage, m_about;
  std::vector<std::string*> m_arguments;
  std::vector<Group> m_groups;
};

#endif // SPECTRAL_EXAMPLES_IO_COMMAND_LINE_H
