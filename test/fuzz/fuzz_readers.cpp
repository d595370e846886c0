// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Bytes become a file, which the programs' reader of its format either reads or refuses in a
// sentence.
//
//   fuzz_readers RUNS SEED    small valid files, damaged
//   fuzz_readers FILE...      these files, of which the extension is the format; without one that
//   is known the first byte is
// or, with SPECTRAL_FUZZ and clang, a target of libFuzzer: -malloc_limit_mb=64, and TMPDIR in
// memory. It needs no corpus.

#include "../../examples/programs/io/index_reader.h"
#include "../../examples/programs/io/input_mesh.h"
#include "../../examples/programs/io/matrix_market_reader.h"
#include "../../examples/programs/io/mesh_io.h"
#include "../../examples/programs/io/npy_reader.h"
#include "fuzz_main.h"
#include "reader_input.h"

#include <CGAL/boost/graph/helpers.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <exception>
#include <filesystem>
#include <fstream>
#include <new>
#include <random>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#ifdef __has_feature
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define SPECTRAL_SANITIZED
#endif
#endif
#if defined(__linux__) && !defined(SPECTRAL_LIBFUZZER) && !defined(SPECTRAL_SANITIZED) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#include <sys/resource.h>
#define SPECTRAL_LIMITS_MEMORY
#endif

#ifdef SPECTRAL_LIBFUZZER
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size,
                                        std::size_t largest_size);
#endif

namespace {

using namespace spectral_test;

// A file that lasts as long as the program.
class File
{
public:
  explicit File(const std::string& extension)
    : m_path(std::filesystem::temp_directory_path() /
             ("spectral_fuzz_" + std::to_string(getpid()) + extension))
  {}
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File()
  {
    std::error_code ignored;
    std::filesystem::remove(m_path, ignored);
  }

  std::string holding(const std::uint8_t* data, const std::size_t size) const
  {
    std::ofstream stream(m_path, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(data), std::streamsize(size));
    stream.close();
    if(!stream)
      throw std::runtime_error("cannot write '" + m_path.string() + "'.");
    return m_path.string();
  }

private:
  std::filesystem::path m_path;
};

// What a reader says is one printable sentence, whatever the file is called.
std::string fault_of_message(std::string message, const std::string& path)
{
  const std::size_t name = message.find(path);
  if(name != std::string::npos)
    message.replace(name, path.size(), "FILE");
  const bool sentence = !message.empty() && message.back() == '.' && message.size() < 500;
  const std::string original = message;
  std::replace_if(
      message.begin(), message.end(), [](const char c) { return c < ' ' || c > '~'; }, '?');
  if(message != original)
    return "a message that cannot be printed: " + message;
  return sentence ? "" : "no sentence: " + message;
}

std::string fault_of_soup(const Polygon_soup& soup, const std::size_t size)
{
  std::size_t corners = soup.points.size();
  for(const auto& polygon : soup.polygons)
    corners += polygon.size();
  if(soup.points.empty() || soup.polygons.empty())
    return "the soup is empty";
  // A triangle of a strip has one index of its own.
  if(corners > 3 * size || soup.polygons.size() > size)
    return "the soup is larger than the file";
  const auto diagnosis = diagnose(soup);
  if(diagnosis.number_of_vertices != soup.points.size() ||
     diagnosis.number_of_faces != soup.polygons.size())
    return "the diagnosis has counted something else";
  if(diagnosis.usable())
    for(const auto& polygon : soup.polygons)
      for(const std::size_t v : polygon)
        if(v >= soup.points.size())
          return "an index is out of range";
  return "";
}

std::string fault_of_mesh(const std::string& path, const std::size_t points, const Mending mending)
{
  const Input_mesh input = read_input_mesh(path, mending, true);
  const std::size_t n = input.mesh.number_of_vertices();
  if(n == 0 || !CGAL::is_valid_polygon_mesh(input.mesh) || !CGAL::is_triangle_mesh(input.mesh))
    return "the mesh is not a valid triangle mesh";
  const Vertex_numbering& numbering = input.numbering;
  if(numbering.number_of_file_vertices() != points || numbering.number_of_mesh_vertices() != n)
    return "the vertices are miscounted";
  for(std::size_t v = 0; v < points; ++v)
    if(numbering.mesh_vertex(v) != no_vertex && numbering.mesh_vertex(v) >= n)
      return "a vertex of the file is none of the mesh";
  for(std::size_t w = 0; w < n; ++w)
    if(numbering.file_vertex(w) >= points)
      return "a vertex of the mesh is none of the file";
  const std::string changes = input.changes_of(path);
  return changes.empty() ? "" : fault_of_message(changes, path);
}

std::string fault_of_npy(const std::string& path, const std::size_t size)
{
  const Eigen::MatrixXd matrix = read_npy(path);
  if(matrix.size() > Eigen::Index(size / 4))
    return "the matrix is larger than the file";
  const std::size_t n = (std::max)(std::size_t(matrix.rows()), std::size_t(1));
  const Eigen::MatrixXd signals = read_signals(path, n);
  return signals.allFinite() && signals.cols() > 0 && signals.rows() == Eigen::Index(n)
             ? ""
             : "the signals are not numbers";
}

std::string fault_of_matrix_market(const std::string& path, const std::size_t size)
{
  long long rows = 0, columns = 0, nonzeros = 0;
  const auto objection = [&](const long long r, const long long c,
                             const long long k) -> std::string {
    rows = r;
    columns = c;
    nonzeros = k;
    return r > 1000 || c > 1000 ? "is too large." : "";
  };
  const Eigen::SparseMatrix<double> matrix = read_matrix_market(path, objection);
  if(matrix.rows() != rows || matrix.cols() != columns)
    return "the matrix has another size than the file says";
  if(matrix.nonZeros() > 2 * nonzeros || matrix.nonZeros() > 2 * Eigen::Index(size))
    return "the matrix has more nonzeros than the file";
  for(Eigen::Index j = 0; j < matrix.outerSize(); ++j)
    for(Eigen::SparseMatrix<double>::InnerIterator it(matrix, j); it; ++it)
      if(it.row() < 0 || it.row() >= matrix.rows())
        return "an entry lies outside of the matrix";
  return "";
}

std::string fault_of_indices(const std::string& path, const std::size_t size)
{
  constexpr std::size_t n = 12;
  const std::vector<std::size_t> indices = read_indices(path, n);
  if(indices.empty() || indices.size() > size)
    return "there are " + std::to_string(indices.size()) + " indices";
  return *std::max_element(indices.begin(), indices.end()) < n ? "" : "an index is out of range";
}

std::string fault_of_mesh_file(const std::string& path, const std::size_t size)
{
  const Polygon_soup soup = read_polygon_soup(path);
  std::string fault = fault_of_soup(soup, size);
  // What is refused as it is may be read when it is repaired.
  for(const Mending mending : {Mending::none, Mending::plain, Mending::full})
    try {
      if(fault.empty())
        fault = fault_of_mesh(path, soup.points.size(), mending);
    } catch(const std::runtime_error& error) {
      fault = fault_of_message(error.what(), path);
    }
  return fault;
}

std::string fault_of_file(const std::string& extension, const std::string& path,
                          const std::size_t size)
{
  if(extension == ".npy")
    return fault_of_npy(path, size);
  if(extension == ".mtx")
    return fault_of_matrix_market(path, size);
  if(extension == ".txt")
    return fault_of_indices(path, size);
  return fault_of_mesh_file(path, size);
}

#ifdef SPECTRAL_LIMITS_MEMORY
// Memory as the file announces it is then no memory at all, which is a fault. Most of it are the
// libraries.
struct Memory_limit
{
  Memory_limit()
  {
    const rlimit limit = {rlim_t(1) << 29, rlim_t(1) << 29};
    setrlimit(RLIMIT_AS, &limit);
  }
} const memory_limit;
#endif

} // namespace

std::string spectral_test::checked(const std::uint8_t* data, const std::size_t size)
{
  if(size == 0)
    return "";
  const std::string extension = extensions[data[0] % extensions.size()];
  static std::deque<File> files;
  while(files.size() < extensions.size())
    files.emplace_back(extensions[files.size()]);
  std::string path;
  try {
    path = files[data[0] % extensions.size()].holding(data + 1, size - 1);
    return fault_of_file(extension, path, size);
  } catch(const std::bad_alloc&) {
    return "it takes more memory than there is";
  } catch(const std::exception& error) {
    return fault_of_message(error.what(), path);
  }
}

spectral_test::Byte_string spectral_test::random_input(std::mt19937& random)
{
  const Seed& seed = valid_files()[random() % valid_files().size()];
  return input_of(seed.extension, mutated(seed.contents, random));
}

spectral_test::Byte_string spectral_test::input_of_file(const std::string& path,
                                                        const Byte_string& contents)
{
  const std::string extension = std::filesystem::path(path).extension().string();
  const bool known = std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
  return known ? input_of(extension, std::string(contents.begin(), contents.end())) : contents;
}

#ifdef SPECTRAL_LIBFUZZER

// Now and then a valid file instead, or a number in place of another.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, const std::size_t size,
                                               const std::size_t largest_size, const unsigned seed)
{
  std::mt19937 random(seed);
  const unsigned choice = random() % 64;
  if(size > 1 && choice != 0 && choice % 4 != 1)
    return LLVMFuzzerMutate(data, size, largest_size);
  const Seed& valid = valid_files()[random() % valid_files().size()];
  const Byte_string bytes = choice == 0 || size < 2
                                ? input_of(valid.extension, valid.contents)
                                : input_of(extensions[data[0] % extensions.size()],
                                           mutated(std::string(data + 1, data + size), random));
  const std::size_t length = (std::min)(bytes.size(), largest_size);
  std::memcpy(data, bytes.data(), length);
  return length;
}

#endif
