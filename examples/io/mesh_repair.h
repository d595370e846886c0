// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_MESH_REPAIR_H
#define SPECTRAL_EXAMPLES_IO_MESH_REPAIR_H

#include "mesh_io.h"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

// What was changed, and how often, in the order in which it was done.
class Repair_log
{
public:
  void add(const std::string& what, const std::size_t count)
  {
    if(count == 0)
      return;
    for(auto& [known, sum] : m_changes)
      if(known == what) {
        sum += count;
        return;
      }
    m_changes.emplace_back(what, count);
  }

  const std::vector<std::pair<std::string, std::size_t>>& changes() const { return m_changes; }

private:
  std::vector<std::pair<std::string, std::size_t>> m_changes;
};

// Makes what can be made an oriented 2-manifold of triangles with area out of the polygons of a file, with CGAL's own repair
// functions. Vertices keep their order as far as they stay. What is still wrong afterwards is for
// `diagnose_polygon_soup()` to say.
Polygon_soup repaired_soup(const Polygon_soup& soup, Repair_log& log);

#endif // SPECTRAL_EXAMPLES_IO_MESH_REPAIR_H
