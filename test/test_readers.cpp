// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The readers of the programs, and what they say of files that are damaged; what they write, and
// what they show.

#include "../examples/programs/io/index_reader.h"
#include "../examples/programs/io/machine_memory.h"
#include "../examples/programs/io/matrix_io.h"
#include "../examples/programs/io/matrix_market_reader.h"
#include "../examples/programs/io/npy_reader.h"
#include "../examples/programs/io/output_files.h"
#include "../examples/programs/io/program.h"
#include "../examples/programs/io/text_mesh_readers.h"
#include "../examples/programs/report/svg_plot.h"

#include "catch.h"

#include <unistd.h>

#include <cstring>
#include <filesystem>

namespace test_readers {

namespace {

// A file that lasts as long as the object.
class File
{
public:
  explicit File(const std::string& bytes)
    : m_path(std::filesystem::temp_directory_path() /
             ("spectral_readers_" + std::to_string(getpid())))
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
  std::string text =
      "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': (" + shape + "), }";
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
  CHECK(read(npy("<f8", "False", "0, 999999999999999", "")).rows() == 0);
  CHECK(read(npy("<f8", "True", "999999999999999, 0", "")).cols() == 0);
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
  CHECK_THROWS_WITH(read(npy("<c16", "False", "3,", raw(numbers))),
                    ContainsSubstring("float64 or float32"));
  CHECK_THROWS_WITH(read(npy("<f8", "False", "1, 3, 2", raw(numbers))),
                    ContainsSubstring("3 dimensions"));
  CHECK_THROWS_WITH(read(npy("<f8", "False", "", raw(numbers))), ContainsSubstring("0 dimensions"));
  CHECK_THROWS_WITH(read(npy("<f8", "False", "3, -2", raw(numbers))), ContainsSubstring("shape"));
  CHECK_THROWS_WITH(read(npy("<f8", "False", "3, \x1b[2J", raw(numbers))),
                    ContainsSubstring("'3, ?[2J'"));
  CHECK_THROWS_WITH(read(npy("<\n8", "False", "3, 2", raw(numbers))), ContainsSubstring("'<?8'"));
  CHECK_THROWS_WITH(read(npy("<f8", "Maybe", "3, 2", raw(numbers))), ContainsSubstring("damaged"));
  CHECK_THROWS_WITH(read(npy("<f8", "False", "3, 2", raw(numbers), 9)),
                    ContainsSubstring("version 9"));
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
  CHECK_THROWS_WITH(indices("3\n100\n"),
                    ContainsSubstring("line 2 ") && ContainsSubstring("0 to 99"));
  CHECK_THROWS_WITH(indices("99999999999999999999999\n"), ContainsSubstring("100 vertices"));
  CHECK_THROWS_WITH(indices("\n\n"), ContainsSubstring("names no vertex"));
  CHECK(indices("\xEF\xBB\xBF# kept\r\n3 # one\r\n0\r\n") == std::vector<std::size_t>({3, 0}));
  CHECK_THROWS_WITH(indices("3\n4\n\n3\n"),
                    ContainsSubstring("line 4 ") && ContainsSubstring("names vertex 3 again"));
  CHECK_THROWS_WITH(indices("0\n1\n0\n"),
                    ContainsSubstring("line 3 ") && ContainsSubstring("a mask of 0 and 1"));
  CHECK_THROWS_WITH(read_indices("/no/such/list.txt", 5), ContainsSubstring("No such file"));
}

TEST_CASE("Headers of Matrix Market are read in any case, and their promises are judged before "
          "memory is taken")
{
  const std::string rest = " matrix coordinate Real General\n2 3 2\n1 1 0.5\n2 3 -2\n";
  const auto no_objection = [](long long, long long, long long) { return std::string(); };
  for(const std::string banner : {"%%MatrixMarket", "%%matrixmarket"}) {
    const File file(banner + rest);
    const Eigen::SparseMatrix<double> matrix = read_matrix_market(file.path(), no_objection);
    CHECK(matrix.rows() == 2);
    CHECK(matrix.coeff(1, 2) == -2);
  }
  const File file(
      "%%MatrixMarket matrix coordinate real general\n2000000000 2000000000 1\n1 1 1\n");
  const auto objection = [](long long rows, long long columns, long long nonzeros) {
    CHECK(rows == 2000000000);
    CHECK(columns == 2000000000);
    return std::string(nonzeros < rows ? "is too large." : "");
  };
  CHECK_THROWS_WITH(read_matrix_market(file.path(), objection),
                    ContainsSubstring("readers") && ContainsSubstring("' is too large."));
}

TEST_CASE("A symmetric matrix of Matrix Market is square")
{
  const auto read = [](const std::string& sizes) {
    const File file("%%MatrixMarket matrix coordinate real symmetric\n" + sizes);
    return read_matrix_market(file.path(),
                              [](long long, long long, long long) { return std::string(); });
  };
  CHECK(read("5 5 1\n5 1 2\n").coeff(0, 4) == 2);
  CHECK_THROWS_WITH(read("2 5 1\n1 5 2\n"),
                    ContainsSubstring("line 2 ") && ContainsSubstring("not square"));
}

TEST_CASE("OFF files may have several vertices and faces on a line")
{
  const auto off = [](const std::string& text) {
    const File file(text);
    return read_off(file.path());
  };
  const Polygon_soup square = off("OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n");
  for(const std::string text :
      {"OFF\n4 2 0\n0 0 0 1 0 0\n1 1 0 0 1 0\n3 0 1 2\n3 0 2 3\n",
       "OFF 4 2 0 0 0 0 1 0 0 1 1 0 0 1 0 3 0 1 2 3 0 2 3",
       "4OFF\n4 2\n0 0 0 2 1 0 0 1 1 1\n0 1 0 1 0 1 3 0 1 2\n3 0\n2 3\n"}) {
    const Polygon_soup soup = off(text);
    CHECK(soup.polygons == square.polygons);
    CHECK(soup.points == square.points);
  }
  // What follows a vertex or a face on its line has no meaning.
  CHECK(off("OFF\n4 2 0\n0 0 0 1 0 0\n1 0 0 9\n1 1 0\n0 1 0\n3 0 1 2 255 0 0\n3 0 2 3\n").points ==
        square.points);
  // Neither reading: the error is that of the usual one.
  CHECK_THROWS_WITH(off("OFF\n4 2 0\n0 0 0 1 0 0\n1 1 0 0 1 0\n3 0 1 2\n3 0 2\n"),
                    ContainsSubstring("it ends after 4 of 4 vertices") ||
                        ContainsSubstring("it ends after 0 of 2 faces"));
  CHECK_THROWS_WITH(off("OFF\n4 2 0\n0 0 0 1 0 0\n1 1 0 0 1 0\n3 0 1 2\n3 0 2 3 4"),
                    ContainsSubstring("it ends"));
}

TEST_CASE("Nothing that is shown controls a terminal, and nothing ends an attribute of a page")
{
  CHECK(printable("plain, \xC3\xA4, \xE2\x82\xAC, \xF0\x9F\x90\xB0") ==
        "plain, \xC3\xA4, \xE2\x82\xAC, \xF0\x9F\x90\xB0");
  CHECK(printable("\x1B[2J\r\n\x7F") == "?[2J???");
  CHECK(printable("\xC2\x9B\x9B\xFF\xE2\x82") == "??????");
  CHECK(escaped("'a' onerror=\"b\"") == "&#39;a&#39; onerror=&quot;b&quot;");
}

namespace {

// An empty folder that lasts as long as the object.
struct Folder
{
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("spectral_folder_" + std::to_string(getpid()));

  Folder() { std::filesystem::create_directory(path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { std::filesystem::remove_all(path); }

  std::string file(const std::string& name) const { return (path / name).string(); }

  void put(const std::string& name, const std::string& text) const
  {
    std::filesystem::create_directories((path / name).parent_path());
    std::ofstream(path / name) << text;
  }

  std::string text(const std::string& name) const
  {
    std::ifstream stream(path / name);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  std::size_t size() const
  {
    return std::size_t(std::distance(std::filesystem::directory_iterator(path), {}));
  }
};

} // namespace

TEST_CASE("If one file cannot have its name, the others are what they were")
{
  const Folder folder;
  folder.put("a", "old");
  {
    Output_files files({});
    for(const std::string name : {"a", "b", "c"}) {
      files.add(folder.file(name));
      std::ofstream(files.temporary(folder.file(name))) << "new";
    }
    std::filesystem::create_directory(folder.path / "c"); // by somebody else, meanwhile
    CHECK_THROWS_AS(files.commit(), Write_error);
    CHECK(folder.text("a") == "old");
    CHECK_FALSE(std::filesystem::exists(folder.path / "b"));
  }
  CHECK(folder.size() == 2); // a and c
  std::filesystem::remove(folder.path / "c");
  Output_files files({});
  for(const std::string name : {"a", "b"}) {
    files.add(folder.file(name));
    std::ofstream(files.temporary(folder.file(name))) << "new";
  }
  files.commit();
  CHECK(folder.text("a") == "new");
  CHECK(folder.text("b") == "new");
  CHECK(folder.size() == 2);
}

TEST_CASE("No output replaces an input, unless it may")
{
  const Folder folder;
  folder.put("in.off", "input");
  std::filesystem::create_symlink("in.off", folder.path / "link.off");
  Output_files files({folder.file("in.off"), ""});
  CHECK_THROWS_WITH(files.add(folder.file("in.off")), ContainsSubstring("read as an input"));
  CHECK_THROWS_WITH(files.add(folder.file("link.off")), ContainsSubstring("read as an input"));
  CHECK_THROWS_WITH(files.add(folder.file("./x/../in.off")), ContainsSubstring("read as an input"));
  files.add(folder.file("in.off"), Output_files::Input::may_be_replaced);
}

TEST_CASE("The memory that is left is within the limits of control groups")
{
  const Folder folder;
  folder.put("proc/meminfo",
             "MemTotal: 8000000 kB\nMemAvailable: 4000000 kB\nSwapFree: 1000000 kB\n");
  CHECK(available_memory(folder.path) == 1024 * 5e6);
  SECTION("of version 2")
  {
    folder.put("proc/self/cgroup", "0::/outer/inner\n");
    folder.put("sys/fs/cgroup/outer/inner/memory.max", "max\n");
    folder.put("sys/fs/cgroup/outer/inner/memory.current", "300000000\n");
    CHECK(available_memory(folder.path) == 1024 * 5e6);
    folder.put("sys/fs/cgroup/outer/memory.max", "1000000000\n");
    folder.put("sys/fs/cgroup/outer/memory.current", "400000000\n");
    folder.put("sys/fs/cgroup/outer/memory.stat",
               "anon 5\ninactive_file 100000000\nactive_file 7\n");
    CHECK(available_memory(folder.path) == 7e8);
  }
  SECTION("of version 1, in a container that does not see its group's path")
  {
    folder.put("proc/self/cgroup", "3:cpuset:/\n4:cpu,memory:/docker/0123\n0::/\n");
    folder.put("sys/fs/cgroup/memory/memory.limit_in_bytes", "2000000000\n");
    folder.put("sys/fs/cgroup/memory/memory.usage_in_bytes", "500000000\n");
    folder.put("sys/fs/cgroup/memory/memory.stat",
               "inactive_file 1\ntotal_inactive_file 250000000\n");
    CHECK(available_memory(folder.path) == 1.75e9);
  }
}

TEST_CASE("No more threads are used than the machine runs at once")
{
  CHECK(usable_threads(1, true) == 1);
  CHECK(usable_threads(100000, true) == (std::max)(1, int(std::thread::hardware_concurrency())));
}

} // namespace test_readers
