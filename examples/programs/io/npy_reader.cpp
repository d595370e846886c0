// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include "npy_reader.h"

#include "text_lines.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

struct Header
{
  std::size_t length = 0; // of everything before the numbers
  std::size_t rows = 0, columns = 1, size_of_number = 8;
  bool by_columns = false, swapped = false;
};

[[noreturn]] void refuse(const std::string& path, const std::string& why)
{
  throw std::runtime_error("cannot read '" + path + "': " + why + ".");
}

bool is_little_endian()
{
  const std::uint16_t one = 1;
  return *reinterpret_cast<const unsigned char*>(&one) == 1;
}

// The text between the parentheses of 'shape'.
void read_shape(Header& header, const std::string& shape, const std::string& path)
{
  std::vector<std::size_t> sizes;
  std::istringstream words(shape);
  for(std::string word; std::getline(words, word, ',');) {
    word.erase(std::remove(word.begin(), word.end(), ' '), word.end());
    if(word.empty())
      continue;
    if(word.size() > 15 || word.find_first_not_of("0123456789") != std::string::npos)
      refuse(path, "its shape " + quoted(shape) + " cannot be read");
    sizes.push_back(std::stoull(word));
  }
  if(sizes.empty() || sizes.size() > 2)
    refuse(path,
           "its array has " + std::to_string(sizes.size()) + " dimensions: save one of one or two");
  header.rows = sizes[0];
  header.columns = sizes.size() == 2 ? sizes[1] : 1;
}

// The format of numpy.lib.format: magic, version, length of the text, and a Python dictionary as
// text.
Header read_header(const std::string& bytes, const std::string& path)
{
  const auto byte = [&](std::size_t i) {
    return static_cast<std::size_t>(static_cast<unsigned char>(bytes[i]));
  };
  if(bytes.size() < 12 || bytes.compare(0, 6, "\x93NUMPY") != 0)
    refuse(path, "it is not an .npy file of NumPy's");
  const bool first_version = byte(6) == 1;
  const std::size_t begin = first_version ? 10 : 12;
  const std::size_t length =
      byte(8) + (byte(9) << 8) + (first_version ? 0 : (byte(10) << 16) + (byte(11) << 24));
  if(byte(6) < 1 || byte(6) > 3)
    refuse(path, "its version " + std::to_string(byte(6)) + " of the .npy format is unknown");
  if(length > 4096 || begin + length > bytes.size())
    refuse(path, "its header is damaged");
  const std::string text = bytes.substr(begin, length);

  Header header;
  header.length = begin + length;
  std::smatch found;
  if(!std::regex_search(text, found, std::regex("'descr' *: *'([^']*)'")))
    refuse(path, "it does not hold plain numbers: save an array of float64 or float32");
  const std::string type = found[1];
  if(type != "<f8" && type != ">f8" && type != "<f4" && type != ">f4")
    refuse(path,
           "its numbers are of type " + quoted(type) + ": save an array of float64 or float32");
  header.size_of_number = type[2] == '8' ? 8 : 4;
  header.swapped = (type[0] == '<') != is_little_endian();
  if(!std::regex_search(text, found, std::regex("'fortran_order' *: *(True|False)")))
    refuse(path, "its header is damaged");
  header.by_columns = found[1] == "True";
  if(!std::regex_search(text, found, std::regex("'shape' *: *\\(([^)]*)\\)")))
    refuse(path, "its header is damaged");
  read_shape(header, found[1], path);
  return header;
}

template <class Number>
Number number_at(const char* bytes, const bool swapped)
{
  char copy[sizeof(Number)];
  std::copy(bytes, bytes + sizeof(Number), copy);
  if(swapped)
    std::reverse(copy, copy + sizeof(Number));
  Number number;
  std::memcpy(&number, copy, sizeof(Number));
  return number;
}

} // namespace

Eigen::MatrixXd read_npy(const std::string& path)
{
  if(std::filesystem::is_directory(path))
    refuse(path, "it is a folder");
  std::ifstream stream(path, std::ios::binary);
  if(!stream)
    refuse(path, std::strerror(errno));
  const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
  const Header header = read_header(bytes, path);
  const std::size_t numbers = (bytes.size() - header.length) / header.size_of_number;
  // Divided, not multiplied: the header may promise anything.
  const bool complete = header.rows == 0 || header.columns == 0
                            ? bytes.size() == header.length
                            : numbers / header.rows == header.columns &&
                                  numbers % header.rows == 0 &&
                                  (bytes.size() - header.length) % header.size_of_number == 0;
  if(!complete)
    refuse(path, "its header announces " + std::to_string(header.rows) + " x " +
                     std::to_string(header.columns) + " numbers, but it holds " +
                     std::to_string(numbers));
  Eigen::MatrixXd matrix(static_cast<Eigen::Index>(header.rows),
                         static_cast<Eigen::Index>(header.columns));
  // By the numbers that are there: the header may promise rows or columns without any.
  for(std::size_t k = 0; k < numbers; ++k) {
    const char* at = bytes.data() + header.length + k * header.size_of_number;
    const std::size_t i = header.by_columns ? k % header.rows : k / header.columns,
                      j = header.by_columns ? k / header.rows : k % header.columns;
    matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
        header.size_of_number == 8 ? number_at<double>(at, header.swapped)
                                   : number_at<float>(at, header.swapped);
  }
  return matrix;
}

Eigen::MatrixXd read_signals(const std::string& path, const std::size_t n)
{
  const Eigen::MatrixXd signals = read_npy(path);
  if(signals.rows() != static_cast<Eigen::Index>(n))
    throw std::runtime_error("'" + path + "' has " + std::to_string(signals.rows()) +
                             " rows, but the mesh has " + std::to_string(n) +
                             " vertices: give one row for each.");
  if(signals.cols() == 0)
    throw std::runtime_error("'" + path + "' has no columns: give at least one signal.");
  for(Eigen::Index j = 0; j < signals.cols(); ++j)
    for(Eigen::Index i = 0; i < signals.rows(); ++i)
      if(!std::isfinite(signals(i, j)))
        throw std::runtime_error("'" + path + "' has an entry that is not finite in row " +
                                 std::to_string(i) + ", column " + std::to_string(j) +
                                 " (counted from 0): correct it.");
  return signals;
}
