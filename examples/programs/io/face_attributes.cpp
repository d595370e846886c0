// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include "face_attributes.h"

#include <CGAL/Spectral_geometry/internal/surface/closest_point_search.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

namespace {

using Vertex = Mesh::Vertex_index;
using Face = Mesh::Face_index;

// The fine faces that a coarse one takes over, each with an area.
using Shares = std::vector<std::vector<std::pair<std::size_t, double>>>;

Eigen::Matrix3d triangle_of(const Mesh& mesh, const Face f)
{
  Eigen::Matrix3d triangle;
  int column = 0;
  for(const Vertex v : mesh.vertices_around_face(mesh.halfedge(f))) {
    const Kernel::Point_3& p = mesh.point(v);
    triangle.col(column++) << p.x(), p.y(), p.z();
  }
  return triangle;
}

double area_of(const Eigen::Matrix3d& t)
{
  return (t.col(1) - t.col(0)).cross(t.col(2) - t.col(0)).norm() / 2;
}

// The middles of n^2 equal parts of a triangle.
template <class Function>
void for_each_part(const Eigen::Matrix3d& t, const int n, const Function& function)
{
  const auto at = [&](const double i, const double j) {
    return Eigen::Vector3d(t.col(0) + (t.col(1) - t.col(0)) * (i / n) +
                           (t.col(2) - t.col(0)) * (j / n));
  };
  for(int i = 0; i < n; ++i)
    for(int j = 0; i + j < n; ++j) {
      function(at(i + 1. / 3, j + 1. / 3));
      if(i + j + 1 < n)
        function(at(i + 2. / 3, j + 2. / 3));
    }
}

// The face whose closest point is closest.
template <class Faces>
Face closest(const Eigen::Vector3d& query, const std::vector<Eigen::Matrix3d>& triangles,
             const Faces& faces)
{
  double least = std::numeric_limits<double>::infinity();
  Face result = *faces.begin();
  for(const Face f : faces) {
    const double d =
        CGAL::Spectral_geometry::internal::closest_point_of_triangle(query, triangles[f])
            .squared_distance;
    if(d < least) {
      least = d;
      result = f;
    }
  }
  return result;
}

void add_faces_at(const Mesh& mesh, const Vertex v, std::vector<Face>& faces)
{
  for(const Face f : mesh.faces_around_target(mesh.halfedge(v)))
    if(f.is_valid())
      faces.push_back(f);
}

void sort_unique(std::vector<Face>& faces)
{
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
}

std::vector<Eigen::Matrix3d> triangles_of(const Mesh& mesh)
{
  std::vector<Eigen::Matrix3d> triangles(mesh.num_faces());
  for(const Face f : mesh.faces())
    triangles[f] = triangle_of(mesh, f);
  return triangles;
}

// By the places of coarse faces in `coarse.faces()`.
Shares shares_of(const Mesh& fine, const Mesh& coarse, const std::vector<std::size_t>& map)
{
  const std::vector<Vertex> handles(coarse.vertices().begin(), coarse.vertices().end());
  const std::vector<Eigen::Matrix3d> triangles = triangles_of(coarse),
                                     fine_triangles = triangles_of(fine);
  std::vector<std::size_t> place(coarse.num_faces()), fine_place(fine.num_faces()),
      number(fine.num_vertices());
  double area = 0;
  std::size_t i = 0;
  for(const Face f : coarse.faces()) {
    place[f] = i++;
    area += area_of(triangles[f]);
  }
  area /= static_cast<double>(i);
  i = 0;
  for(const Vertex v : fine.vertices())
    number[v] = i++;

  Shares shares(coarse.number_of_faces());
  std::vector<std::vector<Face>> members(
      coarse.num_vertices()); // fine faces with a vertex that went there
  std::vector<Face> near;
  i = 0;
  for(const Face f : fine.faces()) {
    fine_place[f] = i++;
    near.clear();
    for(const Vertex v : fine.vertices_around_face(fine.halfedge(f))) {
      const Vertex w = handles[map[number[v]]];
      add_faces_at(coarse, w, near);
      members[w].push_back(f);
    }
    sort_unique(near);
    const double size = area_of(fine_triangles[f]);
    const int n = int(
        (std::min)((std::max)(std::ceil(4 * std::sqrt(size / area)), 1.), 8.)); // a sixteenth each
    for_each_part(fine_triangles[f], n, [&](const Eigen::Vector3d& part) {
      auto& share = shares[place[closest(part, triangles, near)]];
      if(share.empty() || share.back().first != fine_place[f])
        share.emplace_back(fine_place[f], 0.);
      share.back().second += size / (n * n);
    });
  }
  // Faces beside which all that is fine lies closer to others.
  for(const Face f : coarse.faces())
    if(auto& share = shares[place[f]]; share.empty()) {
      near.clear();
      for(const Vertex w : coarse.vertices_around_face(coarse.halfedge(f)))
        near.insert(near.end(), members[w].begin(), members[w].end());
      sort_unique(near);
      if(!near.empty())
        share.emplace_back(fine_place[closest(triangles[f].rowwise().mean(), fine_triangles, near)],
                           1.);
    }
  return shares;
}

// The attributes that are elected together: the channels of a colour, any other alone.
std::vector<std::vector<std::size_t>> electorates(const Attributes& attributes)
{
  std::vector<std::vector<std::size_t>> result;
  std::map<std::string, std::size_t> colours;
  for(std::size_t k = 0; k < attributes.known.size(); ++k) {
    if(attributes.known[k].kind != Attribute::Kind::label)
      continue;
    const auto [channel, colour] = colour_channel_of(attributes.known[k].name);
    const auto known =
        channel < 4 ? colours.emplace(colour, result.size()) : std::make_pair(colours.end(), true);
    if(known.second)
      result.emplace_back();
    (channel < 4 ? result[known.first->second] : result.back()).push_back(k);
  }
  return result;
}

} // namespace

Attributes carried_by_area(const Attributes& fine_attributes, const Mesh& fine, const Mesh& coarse,
                           const std::vector<std::size_t>& map)
{
  Attributes result = fine_attributes;
  if(result.known.empty())
    return result;
  const Shares shares = shares_of(fine, coarse, map);
  for(Attribute& a : result.known)
    a.values.assign(shares.size(), 0.);
  for(std::size_t k = 0; k < result.known.size(); ++k) {
    if(result.known[k].kind == Attribute::Kind::label)
      continue;
    for(std::size_t f = 0; f < shares.size(); ++f) {
      double sum = 0, weight = 0;
      for(const auto& [part, area] : shares[f])
        if(const double x = fine_attributes.known[k].values[part]; std::isfinite(x)) {
          sum += area * x;
          weight += area;
        }
      result.known[k].values[f] =
          weight > 0 ? sum / weight : std::numeric_limits<double>::quiet_NaN();
    }
  }
  for(const std::vector<std::size_t>& together : electorates(fine_attributes)) {
    std::map<std::vector<double>, std::size_t> numbers;
    std::vector<std::vector<double>> combinations;
    std::vector<std::size_t> number; // of the combination of each fine face
    for(std::size_t f = 0; f < fine_attributes.known[together[0]].values.size(); ++f) {
      std::vector<double> combination;
      for(const std::size_t k : together)
        combination.push_back(fine_attributes.known[k].values[f]);
      const auto known = numbers.emplace(combination, combinations.size());
      if(known.second)
        combinations.push_back(std::move(combination));
      number.push_back(known.first->second);
    }
    std::vector<std::pair<double, double>> votes;
    for(std::size_t f = 0; f < shares.size(); ++f) {
      votes.clear();
      for(const auto& [part, area] : shares[f])
        votes.emplace_back(static_cast<double>(number[part]), area);
      if(votes.empty())
        continue;
      const auto winner = static_cast<std::size_t>(elected(votes));
      for(std::size_t j = 0; j < together.size(); ++j)
        result.known[together[j]].values[f] = combinations[winner][j];
    }
  }
  return result;
}
