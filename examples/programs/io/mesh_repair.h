// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_MESH_REPAIR_H
#define SPECTRAL_EXAMPLES_IO_MESH_REPAIR_H

#include "mesh_io.h"

#include <CGAL/Spectral_geometry/Run_control.h>

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

// Something that was changed, and how often: "1 copy of a face removed", "2 copies of faces
// removed".
struct Repair
{
  std::string one, many;
  std::size_t count;

  const std::string& what() const { return count == 1 ? one : many; }
};

// What was changed, in the order in which it was done.
class Repair_log
{
public:
  // `keep_going` is asked between the steps and within them, and returns false to stop.
  explicit Repair_log(std::function<bool()> keep_going = {})
    : m_keep_going(std::move(keep_going))
  {}

  void go_on() const
  {
    if(m_keep_going && !m_keep_going())
      throw CGAL::Spectral_geometry::Cancelled();
  }

  void add(const std::string& one, const std::string& many, const std::size_t count)
  {
    go_on();
    if(count == 0)
      return;
    for(Repair& known : m_changes)
      if(known.many == many) {
        known.count += count;
        return;
      }
    m_changes.push_back({one, many, count});
  }

  const std::vector<Repair>& changes() const { return m_changes; }

private:
  std::vector<Repair> m_changes;
  std::function<bool()> m_keep_going;
};

// Makes what can be made an oriented 2-manifold of triangles with area out of the polygons of a
// file, with CGAL's own repair functions. Vertices keep their order as far as they stay: `vertex`
// says which is each of the file, or `no_vertex`, and `origin` which of the file each is. What is
// still wrong afterwards is for `diagnose_polygon_soup()` to say. Throws `Cancelled` where the log
// says so.
Polygon_soup repaired_soup(const Polygon_soup& soup, Repair_log& log,
                           std::vector<std::size_t>& vertex, std::vector<std::size_t>& origin);

#endif // SPECTRAL_EXAMPLES_IO_MESH_REPAIR_H
