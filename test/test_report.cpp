// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The pieces of the programs' pages that no reader would see to be wrong.

#include "../examples/programs/compare/mode_alignment.h"
#include "../examples/programs/option_words.h"
#include "../examples/programs/report/html_report.h"
#include "../examples/programs/report/judgement.h"
#include "../examples/programs/report/plain_words.h"
#include "../examples/programs/report/png_image.h"
#include "../examples/programs/report/shape_view.h"

#include "catch.h"
#include "shapes.h"

#include <Eigen/QR>

namespace test_report {

namespace {

// Two simplifiers at two sizes, judged in one mass, with numbers that can be found again.
Comparison small_comparison()
{
  Comparison c;
  c.mesh = "a<b>&c.off";
  c.command = "spectral_compare \"a<b>&c.off\"";
  c.vertices = 1000;
  c.faces = 1996;
  c.components = 1;
  c.K = 4;
  const Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(6, 0, 50);
  c.fine.push_back({"lumped", values, 1, 1.5, 1e-12});
  double number = 1.2345;
  for(const std::size_t N : {100, 50})
    for(const char* simplifier : {"spectral", "edge length"}) {
      Simplified s;
      s.simplifier = simplifier;
      s.placement = "midpoint";
      s.requested_vertices = s.vertices = N;
      s.faces = 2 * N - 4;
      s.seconds = 0.25;
      Judgement j;
      j.mass = "lumped";
      j.carried = Map_norms();
      j.carried->norm_L = number++;
      j.carried->norm_D = number++;
      j.coarse_values = 0.9 * values;
      j.C = Eigen::MatrixXd::Identity(4, 4);
      j.floor_norm_L = 0.5;
      j.floor_norm_D = 0;
      j.span_loss = number++ / 100;
      s.judgements.push_back(j);
      c.results.push_back(s);
    }
  return c;
}

std::size_t count(const std::string& text, const std::string& part)
{
  std::size_t n = 0;
  for(std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++n;
  return n;
}

// The numbers of the array `key` of the mesh `name` on a page, of so many bytes each.
std::vector<std::uint32_t> array_on_page(const std::string& html, const std::string& name,
                                         const std::string& key, unsigned bytes)
{
  const std::size_t mesh = html.find("{\"name\":\"" + name + "\"");
  REQUIRE(mesh != std::string::npos);
  const std::size_t begin = html.find("\"" + key + "\":\"", mesh) + key.size() + 4;
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint32_t> result;
  std::uint32_t bits = 0, number = 0;
  unsigned n = 0, taken = 0;
  for(std::size_t i = begin; html[i] != '"' && html[i] != '='; ++i) {
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(html[i]));
    n += 6;
    if(n < 8)
      continue;
    n -= 8;
    number |= (bits >> n & 0xff) << 8 * taken++;
    if(taken == bytes) {
      result.push_back(number);
      number = taken = 0;
    }
  }
  CHECK(taken == 0);
  return result;
}

// A mesh of 642 vertices and one of the first 162 of them in another unit, which values at unit
// area do not see, whose eigenvectors have the other sign.
struct Two_meshes
{
  shapes::Matrices fine = shapes::bumpy_icosphere_matrices(3),
                   coarse = shapes::bumpy_icosphere_matrices(2);
  CGAL::Spectral_geometry::Eigenpairs fine_pairs, coarse_pairs;
  CGAL::Spectral_geometry::Spectral_evaluation evaluation;

  explicit Two_meshes(Eigen::Index K = 12)
  {
    namespace SG = CGAL::Spectral_geometry;
    coarse.V *= 1.5;
    const SG::Laplace_operator L = SG::laplace_operator(fine.V, fine.T, 0.),
                               coarse_L = SG::laplace_operator(coarse.V, coarse.T, 0.);
    fine_pairs = SG::eigenpairs(L, K);
    coarse_pairs = SG::eigenpairs(coarse_L, K);
    Eigen::SparseMatrix<double> P(coarse.V.rows(), fine.V.rows());
    for(Eigen::Index v = 0; v < P.rows(); ++v)
      P.insert(v, v) = 1;
    for(Eigen::Index k = 0; k < K; ++k)
      if(fine_pairs.vectors.col(k).head(162).dot(coarse_pairs.vectors.col(k)) > 0)
        coarse_pairs.vectors.col(k) *= -1;
    evaluation = SG::evaluate_spectrum(L, fine_pairs, coarse_L, coarse_pairs, P, K);
  }

  std::string view(std::size_t most = 1000) const
  {
    return shape_view({fine, fine_pairs}, {coarse, coarse_pairs}, evaluation, most);
  }
};

void check_mesh(const std::string& html, const std::string& name, const shapes::Matrices& mesh,
                std::size_t functions)
{
  const auto points = array_on_page(html, name, "points", 2);
  const auto triangles = array_on_page(html, name, "triangles", 2);
  const std::size_t n = static_cast<std::size_t>(mesh.V.rows());
  REQUIRE(points.size() == 3 * n);
  REQUIRE(triangles.size() == static_cast<std::size_t>(mesh.T.size()));
  CHECK(array_on_page(html, name, "values", 1).size() == functions * n);
  const Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor> T = mesh.T;
  CHECK(std::equal(triangles.begin(), triangles.end(), T.data(),
                   [](std::uint32_t i, int j) { return i == static_cast<std::uint32_t>(j); }));
  // Turned, moved and scaled: distances keep their ratios.
  const auto length = [&points](std::size_t v) {
    return Eigen::Vector3d(points[3 * v] - 1. * points[0], points[3 * v + 1] - 1. * points[1],
                           points[3 * v + 2] - 1. * points[2])
        .norm();
  };
  for(std::size_t v = 2; v < n; ++v)
    CHECK(length(v) / length(1) ==
          Approx((mesh.V.row(static_cast<Eigen::Index>(v)) - mesh.V.row(0)).norm() /
                 (mesh.V.row(1) - mesh.V.row(0)).norm())
              .epsilon(0.001));
}

} // namespace

TEST_CASE("The first stage of best stays out of the way of other options")
{
  using Options = CGAL::Surface_mesh_simplification::Spectral_edge_collapse_options;
  const auto first_stage = [](const Options& options) {
    return first_stage_of_best(options, 20000);
  };
  Options best, late, preserved, bounded, paper = Options::paper();
  CHECK(first_stage(best) == 600000);
  CHECK(first_stage_of_best(best, 600) == 300000);
  late.quadrics_above = 30;
  CHECK(first_stage(late) == 600000);
  late.quadrics_above = 31;
  CHECK(first_stage(late) == 0);
  preserved.preserve_border = true;
  CHECK(first_stage(preserved) == 0);
  bounded.maximum_error = 0.1;
  CHECK(first_stage(bounded) == 0);
  CHECK(first_stage(paper) == 0);
}

TEST_CASE("base64 of lengths with and without padding")
{
  using png_internal::base64;
  CHECK(base64("") == "");
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foo") == "Zm9v");
  CHECK(base64("foobar") == "Zm9vYmFy");
}

TEST_CASE("A chunk of PNG is that of the standard")
{
  CHECK(png_internal::chunk("IEND", "") == std::string("\0\0\0\0IEND\xae\x42\x60\x82", 12));
}

TEST_CASE("The empty ground of a picture takes no bytes, and nothing is lost")
{
  std::string data(100000, '\0');
  for(int i = 0; i < 256; ++i)
    data += static_cast<char>(i);
  const std::string compressed = png_internal::compressed(data);
  CHECK(compressed.size() < 1000);
  std::string again(data.size(), 'x');
  uLongf size = static_cast<uLongf>(again.size());
  REQUIRE(uncompress(reinterpret_cast<Bytef*>(&again[0]), &size,
                     reinterpret_cast<const Bytef*>(compressed.data()),
                     static_cast<uLong>(compressed.size())) == Z_OK);
  CHECK(again == data);
}

TEST_CASE("The shades of a map begin with white and only get darker")
{
  CHECK(sequential_colour(0) == std::array<int, 3>{255, 255, 255});
  double before = 1000;
  for(int i = 0; i <= 50; ++i) {
    const auto c = sequential_colour(i / 50.);
    const double lightness = 0.3 * c[0] + 0.59 * c[1] + 0.11 * c[2];
    CHECK(lightness < before);
    before = lightness;
  }
  CHECK(sequential_colour(7) == sequential_colour(1));
}

TEST_CASE("Numbers are printed with three significant digits")
{
  CHECK(formatted(123.456) == "123.5");
  CHECK(formatted(12.345) == "12.3");
  CHECK(formatted(1.2345) == "1.23");
  CHECK(formatted(0.012345) == "0.0123");
  CHECK(formatted(12345.6) == "12346");
  CHECK(formatted(0) == "0");
  CHECK(formatted(-0.5) == "-0.500");
  CHECK(formatted(1e-9) == "1.00e-09");
  CHECK(formatted(not_computed) == "–");
}

TEST_CASE("Modes are aligned within clusters and nowhere else")
{
  Eigen::VectorXd values(5); // 1 and 2 are one eigenspace, 4 is alone
  values << 0, 20, 20.5, 40, 60;
  const double c = std::cos(0.7), s = std::sin(0.7);
  Eigen::MatrixXd C = Eigen::MatrixXd::Identity(5, 5);
  C.block(1, 1, 2, 2) << c, -s, s, c;
  C(3, 3) = -1;
  const Eigen::MatrixXd R = aligning_rotation(C, values);
  CHECK((R.transpose() * R - Eigen::MatrixXd::Identity(5, 5)).norm() < 1e-14);
  CHECK((R.transpose() * C - Eigen::MatrixXd::Identity(5, 5)).norm() < 1e-14);

  // Between clusters a mixture is an error of the simplification and stays.
  C.setIdentity();
  C.block(2, 2, 2, 2) << c, -s, s, c;
  CHECK((aligning_rotation(C, values) - Eigen::MatrixXd::Identity(5, 5)).norm() < 1e-14);
}

TEST_CASE("More fine modes than coarse vertices are no obstacle to the alignment")
{
  const Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(9, 0, 400);
  const Eigen::MatrixXd R = aligning_rotation(-Eigen::MatrixXd::Identity(4, 4), values);
  CHECK((R + Eigen::MatrixXd::Identity(4, 4)).norm() < 1e-14);
}

TEST_CASE("The page holds every number, escapes names and needs nothing else")
{
  const Comparison c = small_comparison();
  const std::string html = html_report(c);
  for(const Simplified& s : c.results) {
    CHECK(count(html, "<td>" + formatted(s.judgements[0].norms().norm_L) + "</td>") +
              count(html,
                    "<td class='best'>" + formatted(s.judgements[0].norms().norm_L) + "</td>") >=
          1);
    CHECK(count(html, ">" + formatted(s.judgements[0].norms().norm_D) + "</td>") >= 1);
    CHECK(count(html, ">" + formatted(100 * s.judgements[0].span_loss) + "</td>") == 1);
  }
  CHECK(count(html, "a<b>") == 0);
  CHECK(count(html, "a&lt;b&gt;&amp;c.off") >= 2);
  CHECK(count(html, "<img ") == 4);
  CHECK(count(html, "<svg ") == count(html, "</svg>"));
  CHECK(count(html, "<table") == count(html, "</table>"));
  CHECK(count(html, "<tr") == count(html, "</tr>"));
  CHECK(count(html, "<script") == 0);
  CHECK(count(html, "<link") == 0);
  CHECK(count(html, "src='http") == 0);
  CHECK(count(html, "url(") == 0);
  CHECK(count(html, "nan") == 0);
}

TEST_CASE("The page of one run is no comparison, and explains what it has alone")
{
  const Two_meshes meshes;
  Simplified run;
  run.simplifier = "spectral";
  run.placement = "free";
  run.requested_vertices = run.vertices = 162;
  run.faces = 320;
  Comparison c = single_run(meshes.evaluation, run);
  c.mesh = "x.off";
  c.restriction = "closest points of the input";
  c.times = {{"collapses by quadrics", 1.25}, {"relocation", 0.75}, {"total", 3.09}};
  const std::string html = html_report(c);
  CHECK(count(html, "<h1>Spectral simplification: x.off</h1>") == 1);
  CHECK(count(html, "omparison") == 0);
  CHECK(count(html, "closest points of the input") == 2);
  for(const char* absent : {"remesher", "Distances", "Aspect", "Self-inter", "Bold", "closest P<",
                            "<i>metric</i>", "over output size", ">nan", "<tbody>\n</tbody>"}) {
    CAPTURE(absent);
    CHECK(count(html, absent) == 0);
  }
  for(const auto& [what, seconds] : c.times)
    CHECK(count(html, what + "</td><td>" + formatted(seconds)) == 1);
  const Judgement& j = c.results[0].judgements[0];
  for(const double x : {j.norms().norm_L, j.norms().norm_L_common_scale, j.floor_norm_L})
    CHECK(count(html, "<td>" + formatted(x) + "</td>") >= 1);
  for(const double x : {j.error_mean, j.error_input_scale_mean, j.error_input_scale_max})
    CHECK(count(html, "<td>" + formatted(100 * x) + "</td>") >= 1);
  CHECK(j.error_input_scale_mean > j.error_mean + 0.1); // 1.5 times as large
  CHECK(count(html, "<figure class='large'>") == 1);
  CHECK(count(html, "<polyline") == 4); // eigenvalues and their ratios, fine and coarse
  CHECK(count(html, "points=''") == 0);
}

TEST_CASE("The page holds both meshes and the functions on them")
{
  const Two_meshes meshes;
  const std::string html = html_report(small_comparison(), meshes.view());
  CHECK(count(html, "INPUT, 642 vertices</figcaption>") == 1);
  CHECK(count(html, "OUTPUT, 162 vertices</figcaption>") == 1);
  CHECK(count(html, "<option>") == 6);
  CHECK(count(html, "\"gradient\":") == 6);
  check_mesh(html, "fine", meshes.fine, 6);
  check_mesh(html, "coarse", meshes.coarse, 6);
  CHECK(count(html, "<script") == 2);
  CHECK(count(html, "</script>") == 2);
  CHECK(count(html, "http") == count(html, "xmlns='http://www.w3.org/2000/svg'"));
  CHECK(count(html, "src='") == count(html, "src='data:image/png;base64,"));
  CHECK(count(html, "<img ") == 4 + 2); // the pictures without a script
  CHECK(count(html, "nan") == 0);
}

TEST_CASE("Coarse functions have the signs and the scale of the fine ones")
{
  const Two_meshes meshes;
  const std::string html = meshes.view();
  const auto fine = array_on_page(html, "fine", "values", 1),
             coarse = array_on_page(html, "coarse", "values", 1);
  REQUIRE(fine.size() == 6 * 642);
  REQUIRE(coarse.size() == 6 * 162);
  for(std::size_t f = 0; f < 5; ++f) {
    double off = 0, all = 0, largest = 0;
    for(std::size_t v = 0; v < 162; ++v) {
      const double x = fine[642 * f + v] - 127.5, y = coarse[162 * f + v] - 127.5;
      off += (x - y) * (x - y);
      all += x * x;
    }
    for(std::size_t v = 0; v < 642; ++v)
      largest = (std::max)(largest, std::abs(fine[642 * f + v] - 127.5));
    CAPTURE(f);
    CHECK(off < 0.05 * all);
    CHECK(largest > 100); // most of the scale is used
  }
}

TEST_CASE("The distance between the surfaces is zero where they meet")
{
  Two_meshes meshes;
  CHECK(count(meshes.view(), "<option>Distance between the surfaces, % of the diagonal</option>") ==
        1);
  meshes.coarse.V /= 1.5; // in the same unit: its vertices are the first of the fine ones
  const auto d = shape_view_internal::distance_between(meshes.fine, meshes.coarse);
  CHECK(d.coarse.maxCoeff() < 1e-9);
  CHECK(d.fine.head(162).maxCoeff() < 1e-9);
  CHECK(d.fine.tail(480).mean() > 0.1);
  meshes.coarse.V.rowwise() += Eigen::RowVector3d(1000, 0, 0);
  const auto far = shape_view_internal::distance_between(meshes.fine, meshes.coarse);
  const double diagonal =
      (meshes.fine.V.colwise().maxCoeff() - meshes.fine.V.colwise().minCoeff()).norm();
  CHECK(far.coarse.mean() == Approx(100 * 1000 / diagonal).epsilon(0.01));
}

TEST_CASE("Few modes leave few functions, and one of them is enough")
{
  CHECK(count(Two_meshes(3).view(), "<option>Eigenfunction") == 2);
  const std::string html = Two_meshes(1).view();
  CHECK(count(html, "<option>Eigenfunction 1</option>") == 1);
  CHECK(count(html, "<option>") == 2); // with the distance
}

TEST_CASE("A mesh that is too large stays a picture")
{
  const Two_meshes meshes;
  std::string html = meshes.view(300);
  CHECK(count(html, "\"name\":\"fine\"") == 0);
  check_mesh(html, "coarse", meshes.coarse, 1);
  CHECK(count(html, "INPUT has more vertices than the 300 that a page can turn") == 1);
  CHECK(count(html, "<img ") == 2);
  html = meshes.view(100);
  CHECK(count(html, "<script") == 0);
  CHECK(count(html, "<img ") == 2);
}

TEST_CASE("Indices beyond 65,536 vertices have 32 bits")
{
  const shapes::Matrices mesh = shapes::grid_matrices(256, 256);
  REQUIRE(mesh.V.rows() > 65536);
  const std::string data =
      shape_view_internal::mesh_data("fine", mesh, screen_frame(mesh.V), 2, {}).dump();
  CHECK(count(data, "\"wide\":true") == 1);
  const auto triangles = array_on_page(data, "fine", "triangles", 4);
  REQUIRE(triangles.size() == static_cast<std::size_t>(mesh.T.size()));
  const Eigen::Index last = mesh.T.rows() - 1;
  for(int c = 0; c < 3; ++c)
    CHECK(triangles[triangles.size() - 3 + static_cast<std::size_t>(c)] ==
          static_cast<std::uint32_t>(mesh.T(last, c)));
}

TEST_CASE("Sentences say what the figures say")
{
  Comparison c = small_comparison();
  c.results.resize(1);
  c.results[0].shape.area_ratio = 0.98;
  Judgement& j = c.results[0].judgements[0];
  std::string words = plain_words(c, "area");
  CHECK(count(words, "<li>") == 2); // no eigenvalue was judged
  CHECK(count(words, "by 1.23, 2.47 times the estimate for ideal linear elements (0.500)") == 1);
  CHECK(count(words, "The area is 2.00 % smaller than before.") == 1);

  j.error_mean = 0.02;
  j.error_max = 0.07;
  j.error_low_mean = 0.05;
  words = plain_words(c, "mass");
  CHECK(count(words,
              "The first 4 eigenvalues are off by 2.00 % in the mean and by 7.00 % at worst.") ==
        1);
  CHECK(count(words, "less well, to 5.00 %: limbs may have lost their tips.") == 1);
  CHECK(count(words, "The mass is") == 1);
  j.error_low_mean = 0.021;
  CHECK(count(plain_words(c, "area"), "are kept alike, to 2.10 %.") == 1);

  c.results.push_back(c.results[0]);
  c.results[1].judgements[0].error_mean = 0.01;
  words = plain_words(c, "area");
  CHECK(count(words, "off by 1.00 % in the mean, which is better than the mesh's own") == 1);
  CHECK(count(words, "1.23, which is not better than the mesh's own") == 1);
  CHECK(count(words, "nan") == 0);
}

TEST_CASE("Sizes are ascending, families share a colour, variants differ in dashes")
{
  Comparison c = small_comparison();
  CHECK(html_internal::sizes(c) == std::vector<std::size_t>{50, 100});
  Simplified other = c.results[0];
  other.placement = "on_edge";
  c.results.push_back(other);
  const auto styles = html_internal::styles(c);
  REQUIRE(styles.size() == 3);
  CHECK(styles[0].second.colour == styles[2].second.colour);
  CHECK(styles[0].second.dash != styles[2].second.dash);
  CHECK(styles[0].second.colour != styles[1].second.colour);
}

TEST_CASE("A plot of nothing, of one point and of zeros on a logarithmic axis is still a plot")
{
  Plot plot;
  plot.log_x = plot.log_y = GENERATE(false, true);
  CHECK(count(svg(plot), "nan") == 0);
  plot.curves.push_back({"one", {}, {3}, {2}, true});
  CHECK(count(svg(plot), "nan") == 0);
  CHECK(count(svg(plot), "<circle") == 1);
  plot.curves.push_back({"zero", {}, {3}, {0}, true});
  CHECK(count(svg(plot), "nan") == 0);
  CHECK(count(svg(plot), "<circle") == (plot.log_x ? 1 : 2));
}

} // namespace test_report
