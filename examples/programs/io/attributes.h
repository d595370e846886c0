// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_ATTRIBUTES_H
#define SPECTRAL_EXAMPLES_IO_ATTRIBUTES_H

#include <Eigen/SparseCore>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

// A number that a mesh file has at each vertex, or at each face, beside the geometry: a channel of
// a colour, a coordinate of a normal or of a texture, a label, any other. Names are those of PLY.
struct Attribute
{
  // How it is carried to a coarse mesh. A function by P; a colour as well, rounded; a normal
  // likewise, and then it is given its length 1; a label is the one of most weight. `find_kinds()`
  // decides.
  enum class Kind { function, colour, normal, label };

  std::string name;
  std::string type; // "float", "uchar" and so on, as PLY has it
  std::vector<double> values;
  Kind kind = Kind::function;
  // What the values count from 0, as names of materials; or empty.
  std::vector<std::string> words = {};

  bool is_integer() const { return type != "float" && type != "double"; }
};

// All that a file has at its vertices or faces, and what the programs cannot carry ("element
// edge").
struct Attributes
{
  std::vector<Attribute> known;
  std::vector<std::string> unknown;

  const Attribute* find(const std::string& name) const
  {
    const auto found = std::find_if(known.begin(), known.end(),
                                    [&](const Attribute& a) { return a.name == name; });
    return found == known.end() ? nullptr : &*found;
  }

  // The attributes of these names, or nothing where one of them is missing.
  template <std::size_t n>
  std::array<const Attribute*, n> find(const std::array<const char*, n>& names) const
  {
    std::array<const Attribute*, n> found;
    std::transform(names.begin(), names.end(), found.begin(),
                   [this](const char* name) { return find(std::string(name)); });
    if(std::find(found.begin(), found.end(), nullptr) != found.end())
      found.fill(nullptr);
    return found;
  }

  void add(const std::string& name, const std::string& type, std::vector<double> values)
  {
    known.push_back({name, type, std::move(values)});
  }

  void remove(const std::vector<std::string>& names)
  {
    known.erase(std::remove_if(known.begin(), known.end(),
                               [&](const Attribute& a) {
                                 return std::find(names.begin(), names.end(), a.name) !=
                                        names.end();
                               }),
                known.end());
  }

  std::vector<std::string> names() const
  {
    std::vector<std::string> list;
    for(const Attribute& a : known)
      list.push_back(a.name);
    return list;
  }
};

// The channel of a colour that a name means, 0 to 3 for red, green, blue and alpha, and what is
// left of the name: "diffuse_red", "Red", "r", "colorG". No channel: 4.
inline std::pair<std::size_t, std::string> colour_channel_of(const std::string& name)
{
  std::string low = name;
  std::transform(low.begin(), low.end(), low.begin(),
                 [](const unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const std::array<const char*, 4> words = {"red", "green", "blue", "alpha"};
  for(std::size_t c = 0; c < 4; ++c) {
    const std::string word = words[c];
    if(low.size() < word.size())
      continue;
    const std::size_t rest = low.size() - word.size();
    if(low.compare(rest, word.size(), word) == 0)
      return {c, low.substr(0, rest) + '*'};
    if(low.compare(0, word.size(), word) == 0)
      return {c, '*' + low.substr(word.size())};
  }
  if(low.empty())
    return {4, ""};
  const std::size_t letter = std::string("rgba").find(low.back());
  const auto is = [](const int answer) { return answer != 0; };
  const auto at = [&](const std::size_t i) { return static_cast<unsigned char>(name[i]); };
  const std::size_t n = name.size();
  if(letter == std::string::npos || !(n == 1 || !is(std::isalnum(at(n - 2))) ||
                                      (is(std::islower(at(n - 2))) && is(std::isupper(at(n - 1))))))
    return {4, ""};
  return {letter, low.substr(0, n - 1) + '.'};
}

// The channels of the colour of a mesh: of red, green and blue where it has these, else of the
// first with all three channels. Pointers to nothing where there is none.
inline std::array<const Attribute*, 3> colour_of(const Attributes& attributes)
{
  std::map<std::string, std::array<const Attribute*, 3>> colours;
  std::vector<std::string> order = {"*"};
  for(const Attribute& a : attributes.known) {
    const auto [channel, colour] = colour_channel_of(a.name);
    if(channel >= 3)
      continue;
    colours[colour][channel] = &a;
    order.push_back(colour);
  }
  for(const std::string& colour : order) {
    const auto& channels = colours[colour];
    if(std::find(channels.begin(), channels.end(), nullptr) == channels.end())
      return channels;
  }
  return {};
}

// What a channel of a colour has at most. Integers of many bits often hold numbers of few.
inline double full_scale(const std::array<const Attribute*, 3>& colour)
{
  double most = 0, of_type = 255;
  for(const Attribute* const a : colour) {
    for(const double x : a->values)
      most = (std::max)(most, x);
    const bool is_signed = a->type[0] != 'u';
    const double bits = a->type == "short" || a->type == "ushort" ? 16
                        : a->type == "int" || a->type == "uint"   ? 32
                                                                  : 8;
    of_type = (std::max)(of_type, std::ldexp(1., int(bits) - is_signed) - 1);
  }
  for(const double scale : {255., 65535.})
    if(most <= scale && scale < of_type)
      return scale;
  return of_type;
}

// Colours as PLY has them, 0 to 255, whether they are so or up to 1.
inline void add_colours(Attributes& attributes, std::vector<std::vector<double>> channels)
{
  bool small = true;
  for(const auto& channel : channels)
    small =
        small && std::all_of(channel.begin(), channel.end(), [](const double x) { return x <= 1; });
  const std::array<const char*, 4> names = {"red", "green", "blue", "alpha"};
  for(std::size_t c = 0; c < channels.size(); ++c) {
    for(double& x : channels[c])
      x = (std::min)((std::max)(0., std::round(small ? 255 * x : x)), 255.);
    attributes.add(names[c], "uchar", std::move(channels[c]));
  }
}

// Makes colours of the channels red, green, blue with floating numbers from 0 to 1. Others stay
// functions.
inline void find_colours(Attributes& attributes)
{
  const auto is_colour = [&](const std::string& name) {
    const Attribute* const a = attributes.find(name);
    return a != nullptr && !a->is_integer() &&
           std::all_of(a->values.begin(), a->values.end(),
                       [](const double x) { return x >= 0 && x <= 1; });
  };
  std::vector<std::string> names = {"red", "green", "blue"};
  if(!std::all_of(names.begin(), names.end(), is_colour))
    return;
  if(is_colour("alpha"))
    names.push_back("alpha");
  std::vector<std::vector<double>> channels;
  for(const std::string& name : names)
    channels.push_back(attributes.find(name)->values);
  attributes.remove(names);
  add_colours(attributes, std::move(channels));
}

// Decides how each attribute of vertices is carried: integers are channels of a colour where their
// names say so, else labels.
inline void find_kinds(Attributes& attributes)
{
  std::map<std::string, std::set<std::size_t>> channels; // by colours
  for(const Attribute& a : attributes.known) {
    const auto [channel, colour] = colour_channel_of(a.name);
    channels[colour].insert(channel);
  }
  for(Attribute& a : attributes.known) {
    using Kind = Attribute::Kind;
    const auto [channel, colour] = colour_channel_of(a.name);
    const std::set<std::size_t>& others = channels[colour];
    const bool in_colour =
        channel < 4 && (colour == "*" || (others.count(0) && others.count(1) && others.count(2)));
    a.kind = a.name == "nx" || a.name == "ny" || a.name == "nz" ? Kind::normal
             : !a.is_integer()                                  ? Kind::function
             : in_colour                                        ? Kind::colour
                                                                : Kind::label;
  }
}

// The value of most weight.
inline double elected(std::vector<std::pair<double, double>>& votes)
{
  std::sort(votes.begin(), votes.end());
  double most = 0, value = 0;
  for(std::size_t j = 0, end = 0; j < votes.size(); j = end) {
    double weight = 0;
    for(; end < votes.size() && votes[end].first == votes[j].first; ++end)
      weight += votes[end].second;
    if(weight > most) {
      most = weight;
      value = votes[j].first;
    }
  }
  return value;
}

// Carries attributes by P, coarse vertices x vertices of the file. Values that are not finite have
// no weight beside others.
inline Attributes restricted(const Attributes& fine, const Eigen::SparseMatrix<double>& P)
{
  const Eigen::SparseMatrix<double, Eigen::RowMajor> rows = P;
  Attributes coarse = fine;
  for(std::size_t k = 0; k < fine.known.size(); ++k) {
    using Kind = Attribute::Kind;
    const Attribute& a = fine.known[k];
    std::vector<double>& values = coarse.known[k].values;
    values.assign(static_cast<std::size_t>(rows.rows()), 0.);
    std::vector<std::pair<double, double>> votes; // label and weight
    for(Eigen::Index i = 0; i < rows.rows(); ++i) {
      double& value = values[static_cast<std::size_t>(i)];
      votes.clear();
      double weight = 0, all = 0, least = std::numeric_limits<double>::infinity(), most = -least;
      for(Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(rows, i); it; ++it) {
        const double x = a.values[static_cast<std::size_t>(it.col())];
        all += it.value();
        if(!std::isfinite(x))
          continue;
        votes.emplace_back(x, it.value());
        value += it.value() * x;
        weight += it.value();
        least = (std::min)(least, x);
        most = (std::max)(most, x);
      }
      if(votes.empty() && all != 0)
        value = a.is_integer() ? 0. : std::numeric_limits<double>::quiet_NaN();
      else if(a.kind == Kind::label)
        value = elected(votes);
      else if(weight != all && weight != 0)
        value *= all / weight;
      if(a.kind == Kind::colour &&
         !votes.empty()) // in the range of what it is made of, whatever that is
        value = (std::min)((std::max)(least, std::round(value)), most);
    }
  }
  if(coarse.find(std::array<const char*, 3>{"nx", "ny", "nz"})[0] != nullptr) {
    std::array<std::vector<double>*, 3> normal;
    for(Attribute& a : coarse.known)
      if(a.kind == Attribute::Kind::normal)
        normal[static_cast<std::size_t>(a.name[1] - 'x')] = &a.values;
    for(std::size_t i = 0; i < normal[0]->size(); ++i) {
      const double length = std::hypot((*normal[0])[i], (*normal[1])[i], (*normal[2])[i]);
      for(std::vector<double>* const n : normal)
        (*n)[i] /= length > 0 ? length : 1.;
    }
  }
  return coarse;
}

#endif // SPECTRAL_EXAMPLES_IO_ATTRIBUTES_H
