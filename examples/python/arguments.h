// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_PYTHON_ARGUMENTS_H
#define SPECTRAL_PYTHON_ARGUMENTS_H

#include "../programs/io/threads.h"
#include "../programs/option_words.h"

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/operator_coefficients.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace py = pybind11;
namespace SG = CGAL::Spectral_geometry;
using Eigen::Index;
using std::to_string;

// An argument of a type that it cannot have.
struct Wrong_type : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

[[noreturn]] inline void refuse(const std::string& sentence)
{
  throw py::value_error(sentence);
}

inline void warn(const std::string& sentence)
{
  // Two frames up: past the function that called this one.
  if(PyErr_WarnEx(PyExc_UserWarning, sentence.c_str(), 2) != 0)
    throw py::error_already_set();
}

inline std::string type_name(const py::handle& value)
{
  return "of the type " + std::string(py::str(py::type::of(value).attr("__name__")));
}

// For a sentence of one line.
inline std::string shown(const py::handle& value)
{
  const std::string text = py::repr(value);
  return text.size() > 80 || text.find('\n') != std::string::npos ? type_name(value) : text;
}

// The arguments of a function by name, each read with a sentence for what cannot be meant.
class Arguments
{
public:
  explicit Arguments(py::dict values)
    : m_values(std::move(values))
  {}

  py::object operator[](const char* name) const { return m_values[name]; }
  bool has(const char* name) const { return !(*this)[name].is_none(); }

  [[noreturn]] void must_be(const char* name, const std::string& wanted,
                            const bool is_type = false) const
  {
    const std::string sentence =
        std::string(name) + " is " + shown((*this)[name]) + ", it must be " + wanted + ".";
    if(is_type)
      throw Wrong_type(sentence);
    throw py::value_error(sentence);
  }

  Index integer(const char* name, const Index least,
                const Index most = (std::numeric_limits<Index>::max)(),
                const std::string& why = "") const
  {
    const py::object value = (*this)[name];
    if(!PyIndex_Check(value.ptr()) || PyBool_Check(value.ptr()))
      must_be(name, "an integer", true);
    const py::object index = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
    if(!index) {
      PyErr_Clear(); // an array of several
      must_be(name, "an integer", true);
    }
    int overflow = 0;
    const long long result = PyLong_AsLongLongAndOverflow(index.ptr(), &overflow);
    if(overflow != 0 || result < least || result > most)
      must_be(name,
              "an integer from " + to_string(least) +
                  (most == (std::numeric_limits<Index>::max)() ? "" : " to " + to_string(most)) +
                  why);
    return Index(result);
  }

  // All cores unless told otherwise; a warning says that more are wanted.
  int threads() const
  {
    return has("threads")
               ? usable_threads(int(integer("threads", 1, (std::numeric_limits<int>::max)())),
                                "threads=", warn)
               : all_threads();
  }

  double number(const char* name, const double least, const bool itself = true,
                const double most = std::numeric_limits<double>::infinity(),
                const bool finite = true) const
  {
    const py::object value = (*this)[name];
    const double result = PyBool_Check(value.ptr()) ? -1 : PyFloat_AsDouble(value.ptr());
    if(PyErr_Occurred() || PyBool_Check(value.ptr())) {
      PyErr_Clear();
      must_be(name, "a number", true);
    }
    const auto text = [](const double x) { return std::string(py::str(py::float_(x))); };
    if(!(itself ? result >= least : result > least) || !(result <= most) ||
       (finite && std::isinf(result)))
      must_be(name, std::string(finite ? "a finite number " : "a number ") +
                        (itself ? "from " : "above ") + text(least) +
                        (std::isinf(most) ? "" : (itself ? " to " : " and up to ") + text(most)));
    return result;
  }

  bool flag(const char* name) const
  {
    py::detail::make_caster<bool> caster; // without conversions: True and False, NumPy's as well
    if(!caster.load((*this)[name], false))
      must_be(name, "True or False", true);
    return py::detail::cast_op<bool>(caster);
  }

  // One of the words, or nothing where the argument is None and may be.
  std::string word(const char* name, const std::vector<std::string>& words,
                   const bool optional = false) const
  {
    std::string list = optional ? "None" : "";
    for(const std::string& w : words)
      list += (list.empty() ? "'" : w == words.back() ? " or '" : ", '") + w + "'";
    if(optional && !has(name))
      return "";
    if(!py::isinstance<py::str>((*this)[name]))
      must_be(name, list, true);
    const std::string word = (*this)[name].cast<std::string>();
    if(std::find(words.begin(), words.end(), word) == words.end())
      must_be(name, list);
    return word;
  }

  SG::Mass mass() const { return value_of(mass_words, word("mass", words_of(mass_words))); }

  SG::Boundary_condition boundary() const
  {
    return value_of(boundary_words, word("boundary", words_of(boundary_words)));
  }

  // Refuses coefficients and a boundary condition beside it.
  bool intrinsic_delaunay() const
  {
    const bool wanted = flag("intrinsic_delaunay");
    if(wanted && (has("coefficients") || boundary() != SG::Boundary_condition::neumann))
      refuse("intrinsic_delaunay is for the Laplace-Beltrami operator: leave out coefficients and "
             "boundary.");
    return wanted;
  }

  // Reads those of an operator on the n vertices of V or Vc; none where the argument is None.
  SG::Operator_coefficients coefficients(const Index n, const char* name = "coefficients",
                                         const char* of = "V") const
  {
    if(!has(name))
      return {};
    const Eigen::MatrixXd values = matrix(name, n, of);
    if(values.cols() != 7)
      refuse(std::string(name) + " has " + to_string(values.cols()) +
             " columns, it must have 7: density, xx, xy, xz, yy, yz, zz; see "
             "weighted_coefficients().");
    return SG::anisotropic_coefficients(values.rightCols(6), values.col(0));
  }

  // An array of numbers, of real ones or of integers. Not copied if it is one already; `columns` is
  // 0 for one dimension, -1 for any number of columns.
  template <class Number>
  py::array_t<Number> array(const char* name, const Index columns, const std::string& rows_of) const
  {
    constexpr bool real = std::is_floating_point<Number>::value;
    const std::string kinds = real ? "fiu" : "iu", label = name;
    py::array array;
    const py::module_ numpy = py::module_::import("numpy");
    try {
      if(numpy.attr("ma").attr("is_masked")((*this)[name]).template cast<bool>())
        refuse(label + " has masked entries: fill them, or leave them out.");
      array = numpy.attr("asarray")((*this)[name]);
    } catch(const py::error_already_set& error) {
      if(!error.matches(PyExc_ValueError) && !error.matches(PyExc_TypeError))
        throw;
      throw Wrong_type(label + " is not an array of numbers: give each row the same length.");
    }
    if(kinds.find(array.dtype().kind()) == std::string::npos && array.size() != 0)
      throw Wrong_type(label + " has the dtype " + std::string(py::str(array.dtype())) +
                       ", it must hold " +
                       (real ? "real numbers: pass float64." : "integers: pass int32 or int64."));
    if(array.ndim() != (columns == 0 ? 1 : 2) || (columns > 0 && array.shape(1) != columns))
      refuse(label + " has the shape " + shown(array.attr("shape")) + ", it must be " +
             (columns == 0  ? "(n,)"
              : columns < 0 ? "(n, k)"
                            : "(n, " + to_string(columns) + ")") +
             ", one row for each " + rows_of + ".");
    if(array.dtype().kind() == 'u' && array.itemsize() == 8 && !real) {
      const py::object signed_values = array.attr("astype")("int64", py::arg("casting") = "unsafe");
      if(signed_values.attr("__lt__")(0).attr("any")().template cast<bool>())
        refuse(label + " has a number above 9223372036854775807, which is no index.");
      return py::array_t<Number>(py::array(signed_values));
    }
    return py::array_t<Number>(array);
  }

  // Indices in [0, n).
  std::vector<std::size_t> indices(const char* name, const std::size_t n,
                                   const std::string& of) const
  {
    std::vector<std::size_t> result;
    const py::object given = py::module_::import("numpy").attr("asarray")((*this)[name]);
    if(std::string(py::str(given.attr("dtype").attr("kind"))) == "b") { // one for each vertex
      const auto flags = py::array_t<bool>(given);
      if(flags.ndim() != 1 || flags.size() != py::ssize_t(n))
        refuse(std::string(name) + " has the shape " + shown(flags.attr("shape")) + ", but " + of +
               " has " + to_string(n) + " vertices: give True or False for each.");
      for(py::ssize_t i = 0; i < flags.size(); ++i)
        if(flags.at(i))
          result.push_back(std::size_t(i));
      return result;
    }
    const auto values = array<std::int64_t>(name, 0, "vertex");
    // Zeros and ones, as many as vertices, are no indices.
    py::ssize_t flags = 0; // counted by at(), as the array may have strides
    while(flags < values.size() && (values.at(flags) == 0 || values.at(flags) == 1))
      ++flags;
    if(values.size() == py::ssize_t(n) && n > 2 && flags == values.size())
      refuse(std::string(name) + " has a 0 or a 1 for each vertex of " + of +
             ", but integers are indices: pass booleans, or " + name + ".nonzero()[0].");
    for(py::ssize_t i = 0; i < values.size(); ++i) {
      if(values.at(i) < 0 || values.at(i) >= std::int64_t(n))
        refuse(std::string(name) + "[" + to_string(i) + "] is " + to_string(values.at(i)) +
               ", but " + of + " has " + to_string(n) + " vertices: they are counted from 0.");
      result.push_back(std::size_t(values.at(i)));
    }
    return result;
  }

  // A finite matrix.
  Eigen::MatrixXd matrix(const char* name, const Index rows, const std::string& of) const
  {
    const auto values = array<double>(name, -1, "vertex");
    if(values.shape(0) != rows)
      refuse(std::string(name) + " has " + to_string(values.shape(0)) + " rows, but " + of +
             " has " + to_string(rows) + " vertices: give one row for each.");
    Eigen::MatrixXd result = values.template cast<Eigen::MatrixXd>();
    for(Index i = 0; i < result.rows(); ++i)
      for(Index j = 0; j < result.cols(); ++j)
        if(!std::isfinite(result(i, j)))
          refuse(std::string(name) + "[" + to_string(i) + ", " + to_string(j) +
                 "] is not a finite number.");
    return result;
  }

  SG::Mesh_matrices mesh(const char* positions, const char* faces) const
  {
    SG::Mesh_matrices result;
    result.V = array<double>(positions, 3, "vertex").template cast<Eigen::MatrixXd>();
    const auto f = array<std::int64_t>(faces, 3, "triangle");
    const std::int64_t n = result.V.rows();
    if(n > (std::numeric_limits<int>::max)())
      refuse(std::string(positions) + " has more vertices than 31 bits count.");
    result.T.resize(f.shape(0), 3);
    for(py::ssize_t i = 0; i < f.shape(0); ++i)
      for(py::ssize_t j = 0; j < 3; ++j) {
        const std::int64_t v = f.at(i, j);
        if(v < 0 || v >= n)
          refuse(std::string(faces) + "[" + to_string(i) + ", " + to_string(j) + "] is " +
                 to_string(v) + ", but " + positions + " has " + to_string(n) +
                 " vertices: they are counted from 0.");
        result.T(i, j) = int(v);
      }
    return result;
  }

  // Takes any format of SciPy's; rows < 0: any number of them.
  Eigen::SparseMatrix<double> sparse(const char* name, const Index rows, const Index columns,
                                     const char* what = "coarse x fine vertices") const
  {
    const py::module_ scipy = py::module_::import("scipy.sparse");
    const py::object value = (*this)[name];
    if(!scipy.attr("issparse")(value).cast<bool>())
      throw Wrong_type(std::string(name) + " is " + type_name(value) +
                       ", it must be a sparse matrix: pass scipy.sparse.csr_matrix(" + name + ").");
    if(py::len(value.attr("shape")) != 2 ||
       (rows >= 0 && value.attr("shape").attr("__getitem__")(0).cast<Index>() != rows) ||
       value.attr("shape").attr("__getitem__")(1).cast<Index>() != columns)
      refuse(std::string(name) + " has the shape " + shown(value.attr("shape")) + ", it must be (" +
             (rows < 0 ? "any" : to_string(rows)) + ", " + to_string(columns) + "), " + what + ".");
    const std::string kind = py::str(value.attr("dtype").attr("kind"));
    if(kind != "f" && kind != "i" && kind != "u")
      throw Wrong_type(std::string(name) + " has the dtype " +
                       std::string(py::str(value.attr("dtype"))) +
                       ", it must hold real numbers: pass float64.");
    py::object matrix = scipy.attr("csc_matrix")(value, py::arg("dtype") = "float64");
    if(!matrix.attr("has_canonical_format").cast<bool>()) {
      matrix = matrix.attr("copy")();
      matrix.attr("sum_duplicates")();
    }
    auto result = matrix.cast<Eigen::SparseMatrix<double>>();
    for(Index j = 0; j < result.cols(); ++j)
      for(Eigen::SparseMatrix<double>::InnerIterator it(result, j); it; ++it)
        if(!std::isfinite(it.value()))
          refuse(std::string(name) + "[" + to_string(it.row()) + ", " + to_string(j) +
                 "] is not a finite number.");
    return result;
  }

private:
  py::dict m_values;
};

#endif // SPECTRAL_PYTHON_ARGUMENTS_H
