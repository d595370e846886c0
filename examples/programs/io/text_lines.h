// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_TEXT_LINES_H
#define SPECTRAL_EXAMPLES_IO_TEXT_LINES_H

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

// "red, green, blue"
inline std::string joined(const std::vector<std::string>& words, const std::string& between = ", ")
{
  std::string list;
  for(std::size_t i = 0; i < words.size(); ++i)
    list += (i == 0 ? "" : between) + words[i];
  return list;
}

// The beginning of a word of a file, in quotation marks and fit for a message: damaged files hold
// anything.
inline std::string quoted(std::string word)
{
  word.resize((std::min)(word.size(), std::size_t(40)));
  for(char& c : word)
    if(c < ' ' || c > '~')
      c = '?';
  return "'" + word + "'";
}

// What ends the lines of a text that begins so: the carriage return of the first Macintoshes where
// there is no line feed.
inline char line_end(const std::string& start)
{
  return start.find('\n') == std::string::npos && start.find('\r') != std::string::npos ? '\r'
                                                                                        : '\n';
}

// Written at the beginning of a text by editors under Windows.
inline bool has_byte_order_mark(const std::string& text)
{
  return text.compare(0, 3, "\xEF\xBB\xBF") == 0;
}

// The lines of a text and the words in them. A # at the start of a word begins a comment: within a
// word it may belong to a number, as in 1.#QNAN. A line that ends in a backslash goes on in the
// next, and any white space separates.
class Text_lines
{
public:
  explicit Text_lines(const std::string& path)
    : m_stream(path, std::ios::binary)
  {
    std::string start(std::size_t(1) << 16, '\0');
    m_stream.read(&start[0], static_cast<std::streamsize>(start.size()));
    start.resize(static_cast<std::size_t>(m_stream.gcount()));
    m_line_end = line_end(start);
    m_stream.clear();
    m_stream.seekg(0);
  }

  // Goes to the next line with a word in it; false at the end of the file.
  bool next()
  {
    while(read_line())
      if(more())
        return true;
    return false;
  }

  // True if the line has another word.
  bool more()
  {
    while(std::isspace(static_cast<unsigned char>(*m_at)))
      ++m_at;
    return *m_at != '\0';
  }

  // Looks in this line or a later one.
  bool more_or_next() { return more() || next(); }

  // The first character of the next word.
  char peek() { return more() ? *m_at : '\0'; }

  // The next word, empty if there is none.
  std::string word()
  {
    more();
    char* begin = m_at;
    while(*m_at != '\0' && !std::isspace(static_cast<unsigned char>(*m_at)))
      ++m_at;
    return std::string(begin, m_at);
  }

  // The next word as a number, which may be infinite or none: that is for the diagnosis to say.
  double number()
  {
    const bool some = more();
    char* end = m_at;
    const double value = some ? std::strtod(m_at, &end) : 0;
    take(end, "a number");
    return value;
  }

  // The next word as an integer.
  long long integer() { return integers<1>('\0').front(); }

  // The next word as an integer that `mark` may end; after it, and again, further ones may follow,
  // 0 where they are left out.
  template <std::size_t n>
  std::array<long long, n> integers(const char mark)
  {
    std::array<long long, n> values = {};
    const bool some = more();
    char* end = m_at;
    if(some)
      values[0] = std::strtoll(m_at, &end, 10);
    for(std::size_t i = 1; i < n && end != m_at && *end == mark; ++i) {
      ++end;
      if(*end != mark && *end != '\0' && !std::isspace(static_cast<unsigned char>(*end)))
        values[i] = std::strtoll(end, &end, 10);
    }
    take(end, "an integer");
    return values;
  }

  // The numbers that are left on the line.
  std::vector<double> numbers()
  {
    std::vector<double> values;
    while(more())
      values.push_back(number());
    return values;
  }

  // What is left of the line, without the white space around it.
  std::string rest()
  {
    more();
    const std::string text = m_at;
    m_at += text.size();
    return text.substr(0, text.find_last_not_of(" \t\r\v\f") + 1);
  }

  // A place on the line, to which it can return.
  char* place() const { return m_at; }
  void return_to(char* const place) { m_at = place; }

  // The number of the line, from 1.
  std::size_t line() const { return m_number; }

  [[noreturn]] void refuse(const std::string& what) const
  {
    throw std::runtime_error("line " + std::to_string(m_number) + " " + what);
  }

private:
  bool read_line()
  {
    m_line.clear();
    m_at = m_line.data();
    std::string part;
    while(std::getline(m_stream, part, m_line_end)) {
      ++m_number;
      if(m_number == 1 && has_byte_order_mark(part))
        part.erase(0, 3);
      while(!part.empty() && std::isspace(static_cast<unsigned char>(part.back())))
        part.pop_back();
      std::size_t comment = part.find('#');
      while(comment != std::string::npos && comment > 0 &&
            !std::isspace(static_cast<unsigned char>(part[comment - 1])))
        comment = part.find('#', comment + 1);
      const bool goes_on = comment == std::string::npos && !part.empty() && part.back() == '\\';
      if(comment != std::string::npos || goes_on)
        part.erase(goes_on ? part.size() - 1 : comment);
      m_line += part;
      m_at = m_line.data();
      if(!goes_on)
        return true;
      m_line += ' ';
    }
    m_at = m_line.data();
    return !m_line.empty();
  }

  // The word from here to `end` was read as what it is to be.
  void take(char* end, const char* what)
  {
    if(end == m_at || (*end != '\0' && !std::isspace(static_cast<unsigned char>(*end)))) {
      const std::string wrong = word();
      refuse(wrong.empty() ? std::string("ends where ") + what + " is expected"
                           : "holds " + quoted(wrong) + " where " + what + " is expected");
    }
    m_at = end;
  }

  std::ifstream m_stream;
  char m_line_end = '\n';
  std::string m_line;
  char* m_at = m_line.data();
  std::size_t m_number = 0;
};

#endif // SPECTRAL_EXAMPLES_IO_TEXT_LINES_H
