// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_VERTEX_ATTRIBUTES_H
#define SPECTRAL_EXAMPLES_IO_VERTEX_ATTRIBUTES_H

#include <Eigen/SparseCore>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

// A number that a mesh file has at each vertex beside its position: a channel of a colour, a coordinate of a normal or of a
// texture, a label, any other. Names are those of PLY.
struct Vertex_attribute
{
  // How it is carried to a coarse mesh. A function by P; a colour as well, rounded and kept in 0 to 255; a coordinate of a normal
  // likewise, and then the normal is given its length 1; a label is the one of most weight in a row of P.
  enum class Kind { function, colour, normal, label };

  std::string name;
  std::string type; // "float", "uchar" and so on, as PLY has it
  std::vector<double> values;

  Kind kind() const
  {
    const auto is_one_of = [this](const auto&... names) { return ((name == names) || ...); };
    if(is_one_of("nx", "ny", "nz"))
      return Kind::normal;
    if(type == "float" || type == "double")
      return Kind::function;
    return is_one_of("red", "green", "blue", "alpha") ? Kind::colour : Kind::label;
  }
};

// All that a file has, and the names of what it has beside and the programs cannot carry ("element edge", "property quality of
// face").
struct Vertex_attributes
{
  std::vector<Vertex_attribute> known;
  std::vector<std::string> unknown;

  const Vertex_attribute* find(const std::string& name) const
  {
    const auto found =
        std::find_if(known.begin(), known.end(), [&](const Vertex_attribute& a) { return a.name == name; });
    return found == known.end() ? nullptr : &*found;
  }

  // Those of `names`, or nothing where one of them is missing.
  template <std::size_t n>
  std::array<const Vertex_attribute*, n> find(const std::array<const char*, n>& names) const
  {
    std::array<const Vertex_attribute*, n> found;
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
                               [&](const Vertex_attribute& a) {
                                 return std::find(names.begin(), names.end(), a.name) != names.end();
                               }),
                known.end());
  }

  std::vector<std::string> names() const
  {
    std::vector<std::string> list;
    for(const Vertex_attribute& a : known)
      list.push_back(a.name);
    return list;
  }
};

// A number as a channel of a colour has it; 0 where it is none.
inline double colour_channel(const double x)
{
  return (std::min)((std::max)(0., std::round(x)), 255.);
}

// Colours as PLY has them, 0 to 255, whether they are so or up to 1.
inline void add_colours(Vertex_attributes& attributes, std::vector<std::vector<double>> channels)
{
  bool small = true;
  for(const auto& channel : channels)
    small = small && std::all_of(channel.begin(), channel.end(), [](const double x) { return x <= 1; });
  const std::array<const char*, 4> names = {"red", "green", "blue", "alpha"};
  for(std::size_t c = 0; c < channels.size(); ++c) {
    for(double& x : channels[c])
      x = colour_channel(small ? 255 * x : x);
    attributes.add(names[c], "uchar", std::move(channels[c]));
  }
}

// Makes colours of channels with floating numbers from 0 to 1. Others stay functions.
inline void find_colours(Vertex_attributes& attributes)
{
  const auto is_colour = [&](const std::string& name) {
    const Vertex_attribute* const a = attributes.find(name);
    return a != nullptr && a->kind() == Vertex_attribute::Kind::function &&
           std::all_of(a->values.begin(), a->values.end(), [](const double x) { return x >= 0 && x <= 1; });
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

// Carries attributes by P, coarse vertices x vertices of the file.
inline Vertex_attributes restricted(const Vertex_attributes& fine, const Eigen::SparseMatrix<double>& P)
{
  const Eigen::SparseMatrix<double, Eigen::RowMajor> rows = P;
  Vertex_attributes coarse;
  coarse.unknown = fine.unknown;
  for(const Vertex_attribute& a : fine.known) {
    using Kind = Vertex_attribute::Kind;
    const Kind kind = a.kind();
    std::vector<double> values(static_cast<std::size_t>(rows.rows()));
    std::vector<std::pair<double, double>> votes; // label and weight
    for(Eigen::Index i = 0; i < rows.rows(); ++i) {
      double& value = values[static_cast<std::size_t>(i)];
      votes.clear();
      for(Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(rows, i); it; ++it) {
        const double x = a.values[static_cast<std::size_t>(it.col())];
        if(kind == Kind::label)
          votes.emplace_back(x, it.value());
        else
          value += it.value() * x;
      }
      if(kind == Kind::colour)
        value = colour_channel(value);
      std::sort(votes.begin(), votes.end());
      double most = 0;
      for(std::size_t j = 0, end = 0; j < votes.size(); j = end) {
        double weight = 0;
        for(; end < votes.size() && votes[end].first == votes[j].first; ++end)
          weight += votes[end].second;
        if(weight > most) {
          most = weight;
          value = votes[j].first;
        }
      }
    }
    coarse.add(a.name, a.type, std::move(values));
  }
  if(coarse.find(std::array<const char*, 3>{"nx", "ny", "nz"})[0] != nullptr) {
    std::array<std::vector<double>*, 3> normal;
    for(Vertex_attribute& a : coarse.known)
      if(a.kind() == Vertex_attribute::Kind::normal)
        normal[static_cast<std::size_t>(a.name[1] - 'x')] = &a.values;
    for(std::size_t i = 0; i < normal[0]->size(); ++i) {
      const double length = std::hypot((*normal[0])[i], (*normal[1])[i], (*normal[2])[i]);
      for(std::vector<double>* const n : normal)
        (*n)[i] /= length > 0 ? length : 1.;
    }
  }
  return coarse;
}

#endif // SPECTRAL_EXAMPLES_IO_VERTEX_ATTRIBUTES_H
