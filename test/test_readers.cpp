// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The readers of the programs: NumPy arrays and lists of indices, and what they say of files that are neither.

#include "../examples/io/index_reader.h"
#include "../examples/io/matrix_io.h"
#include "../examples/io/npy_reader.h"

#include "catch.h"

#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

using Catch::Matchers::ContainsSubstring;

namespace {

// A file that lasts as long as the object.
class File
{
public:
  explicit File(const std::string& bytes)
    : m_path(std::filesystem::temp_directory_path() / ("spectral_readers_" + std::to_string(getpid())))
  {
    std::ofstream(m_path, std::ios::binary) << bytes;
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() { std::filesystem::remove(m_path); }

  std::string path() const { return m_path.string(); }

private:
  std::filesystem::path m_path;
};

template <class Number>
std::string raw(const std::vector<Number>& numbers, const bool reversed = false)
{
  std::string bytes;
  for(const Number x : numbers) {
    char copy[sizeof(Number)];
    std::memcpy(copy, &x, sizeof(Number));
    if(reversed)
      std::reverse(copy, copy + sizeof(Number));
    bytes.append(copy, sizeof(Number));
  }
  return bytes;
}

// As numpy.lib.format describes it, not with the writer's code.
std::string npy(const std::string& type, const std::string& order, const std::string& shape,
                const std::string& data, const int version = 1)
{
  std::string text = "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': (" + shape + "), }";
  text.append(117 - text.size(), ' ');
  text += '\n';
  std::string bytes = "\x93NUMPY";
  bytes += char(version);
  bytes += '\0';
  bytes += char(text.size());
  bytes.append(version == 1 ? 1 : 3, '\0');
  return bytes + text + data;
}

Eigen::MatrixXd read(const std::string& bytes)
{
  const File file(bytes);
  return read_npy(file.path());
}

const std::vector<double> numbers = {1, 2, 3, 4, 5, 6};
const std::vector<float> floats = {1, 2, 3, 4, 5, 6};

} // namespace

TEST_CASE("Arrays of both types, orders, byte orders and versions are read")
{
  Eigen::MatrixXd by_rows(3, 2), by_columns(3, 2);
  by_rows << 1, 2, 3, 4, 5, 6;
  by_columns << 1, 4, 2, 5, 3, 6;
  CHECK(read(npy("<f8", "False", "3, 2", raw(numbers))) == by_rows);
  CHECK(read(npy("<f8", "True", "3, 2", raw(numbers))) == by_columns);
  CHECK(read(npy("<f4", "False", "3, 2", raw(floats))) == by_rows);
  CHECK(read(npy("<f4", "True", "3, 2", raw(floats))) == by_columns);
  CHECK(read(npy(">f8", "False", "3, 2", raw(numbers, true))) == by_rows);
  CHECK(read(npy(">f4", "True", "3, 2", raw(floats, true))) == by_columns);
  CHECK(read(npy("<f8", "False", "3, 2", raw(numbers), 2)) == by_rows);
  CHECK(read(npy("<f8", "False", "6,", raw(numbers))) ==
        Eigen::Map<const Eigen::VectorXd>(numbers.data(), 6));
  CHECK(read(npy("<f8", "False", "0, 2", "")).cols() == 2);
}

TEST_CASE("What write_npy() writes is read again")
{
  const Eigen::MatrixXd matrix = Eigen::MatrixXd::Random(7, 3);
  const Eigen::VectorXd vector = Eigen::VectorXd::Random(5);
  const File file("");
  write_npy(file.path(), matrix, "matrix");
  CHECK(read_npy(file.path()) == matrix);
  write_npy(file.path(), vector, "vector");
  CHECK(read_npy(file.path()) == vector);
}

TEST_CASE("Files that are no such array are refused in a sentence")
{
  const std::string good = npy("<f8", "False", "3, 2", raw(numbers));
  CHECK_THROWS_WITH(read(""), ContainsSubstring("not an .npy file"));
  CHECK_THROWS_WITH(read("0.5 0.25\n0.125 1\n"), ContainsSubstring("not an .npy file"));
  CHECK_THROWS_WITH(read(good.substr(0, 60)), ContainsSubstring("damaged"));
  CHECK_THROWS_WITH(read(good.substr(0, good.size() - 8)),
                    ContainsSubstring("3 x 2 numbers, but it holds 5"));
  CHECK_THROWS_WITH(read(good.substr(0, good.size() - 1)), ContainsSubstring("but it holds 5"));
  CHECK_THROWS_WITH(read(good + "x"), ContainsSubstring("3 x 2"));
  CHECK_THROWS_WITH(read(npy("<i8", "False", "3, 2", raw(numbers))), ContainsSubstring("'<i8'"));
  CHECK_THROWS_WITH(read(npy("<c16", "False", "3,", raw(numbers))), ContainsSubstring("float64 or float32"));
  CHECK_THROWS_WITH(read(npy("<f8", "False", "1, 3, 2", raw(numbers))), ContainsSubstring("3 dimensions"));
  CHECK_THROWS_WITH(read(npy("<f8", "False", "", raw(numbers))), ContainsSubstring("0 dimensions"));
  CHECK_THROWS_WITH(read(npy("<f8", "False", "3, -2", raw(numbers))), ContainsSubstring("shape"));
  CHECK_THROWS_WITH(read(npy("<f8", "Maybe", "3, 2", raw(numbers))), ContainsSubstring("damaged"));
  CHECK_THROWS_WITH(read(npy("<f8", "False", "3, 2", raw(numbers), 9)), ContainsSubstring("version 9"));
  // A promise of more than any memory.
  CHECK_THROWS_WITH(read(npy("<f8", "False", "999999999999999, 999999999999999", raw(numbers))),
                    ContainsSubstring("it holds 6"));
  CHECK_THROWS_WITH(read_npy("/no/such/file.npy"), ContainsSubstring("No such file"));
  CHECK_THROWS_WITH(read_npy("/"), ContainsSubstring("folder"));
}

TEST_CASE("Signals must suit the mesh")
{
  std::vector<double> holed = numbers;
  holed[3] = std::numeric_limits<double>::quiet_NaN();
  const auto signals = [](const std::string& bytes, const std::size_t n) {
    const File file(bytes);
    return read_signals(file.path(), n);
  };
  CHECK(signals(npy("<f8", "False", "3, 2", raw(numbers)), 3).rows() == 3);
  CHECK_THROWS_WITH(signals(npy("<f8", "False", "3, 2", raw(numbers)), 4),
                    ContainsSubstring("3 rows, but the mesh has 4"));
  CHECK_THROWS_WITH(signals(npy("<f8", "False", "3, 0", ""), 3), ContainsSubstring("no columns"));
  CHECK_THROWS_WITH(signals(npy("<f8", "False", "3, 2", raw(holed)), 3),
                    ContainsSubstring("row 1, column 1"));
}

TEST_CASE("Indices are read one per line, and a bad line is named")
{
  const auto indices = [](const std::string& text) {
    const File file(text);
    return read_indices(file.path(), 100);
  };
  CHECK(indices("3\n0\n\n 99 \r\n7") == std::vector<std::size_t>({3, 0, 99, 7}));
  CHECK_THROWS_WITH(indices("3\n4 5\n"), ContainsSubstring("line 2 "));
  CHECK_THROWS_WITH(indices("3\n\nfour\n"), ContainsSubstring("line 3 "));
  CHECK_THROWS_WITH(indices("-1\n"), ContainsSubstring("line 1 "));
  CHECK_THROWS_WITH(indices("1.5\n"), ContainsSubstring("line 1 "));
  CHECK_THROWS_WITH(indices("3\n100\n"), ContainsSubstring("line 2 ") && ContainsSubstring("0 to 99"));
  CHECK_THROWS_WITH(indices("99999999999999999999999\n"), ContainsSubstring("100 vertices"));
  CHECK_THROWS_WITH(indices("\n\n"), ContainsSubstring("names no vertex"));
  CHECK_THROWS_WITH(read_indices("/no/such/list.txt", 5), ContainsSubstring("No such file"));
}
