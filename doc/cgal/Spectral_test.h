// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_TEST_H
#define SPECTRAL_TEST_H

// What the tests are written in: every file is a program that runs its test cases one after the
// other. The first check that fails ends it with EXIT_FAILURE; whatever is in scope by CAPTURE or
// INFO is printed. A test case is run again until each of its SECTIONs and each value of its
// GENERATEs had its turn, in all combinations.

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <functional>
#include <initializer_list>
#include <iostream>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace plain_test {

struct Test_case
{
  const char* name;
  void (*run)();
};
struct Choice
{
  std::size_t taken, count;
};

inline std::vector<Test_case> test_cases;
inline std::vector<Choice> choices; // of this run, in their order
inline std::size_t next_choice;     // the first that this run has not met yet
// By depth: 1 + the choice that entered a section in this run, or 0.
inline std::vector<std::size_t> sections;
inline std::vector<std::string> notes; // what CAPTURE and INFO hold
inline std::size_t checks;

inline bool add(const char* name, const std::string& tags, void (*run)())
{
  if(tags.find("[.") == std::string::npos) // what is left out unless it is asked for
    test_cases.push_back({name, run});
  return true;
}

inline std::size_t choose(std::size_t count)
{
  if(next_choice == choices.size())
    choices.push_back({0, count});
  return choices[next_choice++].taken;
}

inline bool another_run()
{
  while(!choices.empty() && choices.back().taken + 1 == choices.back().count)
    choices.pop_back();
  return !choices.empty() && ++choices.back().taken;
}

template <class T>
T generate(std::initializer_list<T> values)
{
  return values.begin()[choose(values.size())];
}

template <class T>
struct Range
{
  T begin, end;
};

template <class T>
Range<T> range(const T begin, const T end)
{
  return {begin, end};
}

template <class T>
T generate(std::initializer_list<Range<T>> values) // of one
{
  return values.begin()->begin +
         T(choose(std::size_t(values.begin()->end - values.begin()->begin)));
}

class Section // entered, unless it had its turn, or another of this depth has it
{
public:
  explicit Section(const std::string&)
  {
    if(sections.back() != 0) {
      choices[sections.back() - 1].count = 2; // this one is met when that one is passed over
    } else if(choose(1) == 0) {
      m_entered = true;
      sections.back() = next_choice;
      sections.push_back(0);
    }
  }
  ~Section()
  {
    if(m_entered)
      sections.pop_back();
  }
  explicit operator bool() const { return m_entered; }

private:
  bool m_entered = false;
};

struct Note
{
  template <class... Values>
  explicit Note(const char* names, const Values&... values)
  {
    std::ostringstream text;
    ((text << names), ..., (text << ' ' << values));
    notes.push_back(text.str());
  }
  ~Note() { notes.pop_back(); }
};

inline void check(bool holds, const char* text, const char* file, int line,
                  const std::string& found = "")
{
  ++checks;
  if(holds)
    return;
  std::cerr << file << ':' << line << ": " << text << " does not hold\n" << found;
  for(const std::string& note : notes)
    std::cerr << note << '\n';
  std::exit(EXIT_FAILURE);
}

class Approx // equal to a hundred rounding errors of float, or as epsilon() and margin() say
{
public:
  explicit Approx(double value)
    : m_value(value)
  {}
  Approx& epsilon(double e)
  {
    m_epsilon = e;
    return *this;
  }
  Approx& margin(double m)
  {
    m_margin = m;
    return *this;
  }
  friend bool operator==(double x, const Approx& a)
  {
    const double d = std::abs(x - a.m_value);
    return x == a.m_value || d <= a.m_margin || d <= a.m_epsilon * std::abs(a.m_value);
  }
  friend bool operator!=(double x, const Approx& a) { return !(x == a); }

private:
  double m_value, m_epsilon = 100. * std::numeric_limits<float>::epsilon(), m_margin = 0;
};

struct Matcher
{
  std::function<bool(const std::string&)> matches;
};
inline Matcher ContainsSubstring(const std::string& part)
{
  return {[part](const std::string& s) { return s.find(part) != s.npos; }};
}
inline Matcher operator&&(Matcher a, Matcher b)
{
  return {[a, b](const std::string& s) { return a.matches(s) && b.matches(s); }};
}
inline Matcher operator||(Matcher a, Matcher b)
{
  return {[a, b](const std::string& s) { return a.matches(s) || b.matches(s); }};
}

inline void check_that(const std::string& s, const Matcher& m, const char* text, const char* file,
                       int line)
{
  check(m.matches(s), text, file, line, "the text is: " + s + '\n');
}

inline int run_all()
{
  for(const Test_case& test : test_cases) {
    choices.clear();
    do {
      next_choice = 0;
      sections.assign(1, 0);
      try {
        test.run();
      } catch(const std::exception& error) {
        check(false, test.name, "an exception left the test case", 0,
              error.what() + std::string("\n"));
      }
    } while(another_run());
  }
  std::cout << checks << " checks in " << test_cases.size() << " test cases hold\n";
  return checks > 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

} // namespace plain_test

#define SPECTRAL_TEST_JOIN2(a, b) a##b
#define SPECTRAL_TEST_JOIN(a, b) SPECTRAL_TEST_JOIN2(a, b)
#define SPECTRAL_TEST_NAME(a) SPECTRAL_TEST_JOIN(spectral_test_##a, __LINE__)
#define TEST_CASE(...) \
  SPECTRAL_TEST_CASE(SPECTRAL_TEST_NAME(case_), SPECTRAL_TEST_NAME(added_), __VA_ARGS__, "", )
#define SPECTRAL_TEST_CASE(function, added, name, tags, ...)       \
  static void function();                                          \
  static const bool added = plain_test::add(name, tags, function); \
  static void function()
#define SECTION(...) if(const plain_test::Section SPECTRAL_TEST_NAME(section_){__VA_ARGS__})
#define GENERATE(...) plain_test::generate({__VA_ARGS__})
#define CAPTURE(...) \
  const plain_test::Note SPECTRAL_TEST_NAME(note_)(#__VA_ARGS__ " are", __VA_ARGS__)
#define INFO(...) \
  const plain_test::Note SPECTRAL_TEST_NAME(note_)("", (std::ostringstream() << __VA_ARGS__).str())
#define CHECK(...) \
  plain_test::check(static_cast<bool>(__VA_ARGS__), #__VA_ARGS__, __FILE__, __LINE__)
#define CHECK_FALSE(...) \
  plain_test::check(!static_cast<bool>(__VA_ARGS__), "not " #__VA_ARGS__, __FILE__, __LINE__)
#define REQUIRE(...) CHECK(__VA_ARGS__)
#define REQUIRE_FALSE(...) CHECK_FALSE(__VA_ARGS__)
#define SUCCEED(...) CHECK(true)
#define CHECK_THAT(string, ...) \
  plain_test::check_that(string, __VA_ARGS__, #string ", " #__VA_ARGS__, __FILE__, __LINE__)
#define CHECK_NOTHROW(...) \
  do {                     \
    __VA_ARGS__;           \
    CHECK(true);           \
  } while(false) // what is thrown ends the program
#define CHECK_THROWS_AS(expression, type) SPECTRAL_TEST_THROWS(expression, type, CHECK(true))
#define CHECK_THROWS_WITH(expression, ...) \
  SPECTRAL_TEST_THROWS(expression, std::exception, CHECK_THAT(error.what(), __VA_ARGS__))
#define SPECTRAL_TEST_THROWS(expression, type, then)                              \
  do {                                                                            \
    bool spectral_test_thrown = false;                                            \
    try {                                                                         \
      static_cast<void>(expression);                                              \
    } catch([[maybe_unused]] const type& error) {                                 \
      spectral_test_thrown = true;                                                \
      then;                                                                       \
    }                                                                             \
    if(!spectral_test_thrown)                                                     \
      plain_test::check(false, #expression " throws " #type, __FILE__, __LINE__); \
  } while(false)

namespace CGAL::Spectral_geometry {}
namespace CGAL::Surface_mesh_simplification {}
namespace SG = CGAL::Spectral_geometry;
namespace SMS = CGAL::Surface_mesh_simplification;

using plain_test::Approx;
using plain_test::ContainsSubstring;
using plain_test::range;

int main()
{
  return plain_test::run_all();
}

#endif // SPECTRAL_TEST_H
