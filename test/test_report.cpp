// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The pieces of the comparison's page that no reader would see to be wrong.

#include "../examples/programs/compare/mode_alignment.h"
#include "../examples/programs/report/html_report.h"
#include "../examples/programs/report/png_image.h"

#include "catch.h"

#include <Eigen/QR>

#include <cmath>
#include <string>

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

// The code of RFC 1951 that begins at bit `at`, as far as Deflated_runs writes it, read anew.
struct Inflater
{
  const std::string& data;
  std::size_t at = 0;

  unsigned bit()
  {
    const unsigned b = static_cast<unsigned char>(data[at / 8]) >> at % 8 & 1;
    ++at;
    return b;
  }
  unsigned code(int length, unsigned begun = 0)
  {
    for(int i = 0; i < length; ++i)
      begun = begun << 1 | bit();
    return begun;
  }
  unsigned symbol()
  {
    const unsigned seven = code(7);
    if(seven < 24)
      return 256 + seven;
    const unsigned eight = code(1, seven);
    if(eight < 0xc0)
      return eight - 0x30;
    return eight < 0xc8 ? 280 + eight - 0xc0 : 144 + code(1, eight) - 0x190;
  }
  std::string text()
  {
    at = 3;
    std::string result;
    for(unsigned s = symbol(); s != 256; s = symbol())
      if(s < 256)
        result += static_cast<char>(s);
      else
        result.append(code(5) == 0 ? (s == 285 ? 258 : s - 254) : 0, result.back());
    return result;
  }
};

} // namespace

TEST_CASE("base64 of lengths with and without padding")
{
  using png_internal::base64;
  CHECK(base64("") == "");
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foo") == "Zm9v");
  CHECK(base64("foobar") == "Zm9vYmFy");
}

TEST_CASE("A chunk of PNG and its check sums are those of the standard")
{
  using namespace png_internal;
  CHECK(chunk("IEND", "") == std::string("\0\0\0\0IEND\xae\x42\x60\x82", 12));
  // what zlib makes of "abc" with its fixed codes, and Adler-32, 0x024d0127
  CHECK(zlib_compressed("abc") == std::string("\x78\x01\x4b\x4c\x4a\x06\x00\x02\x4d\x01\x27", 11));
}

TEST_CASE("Runs are deflated, and nothing is lost")
{
  using png_internal::Deflated_runs;
  std::string every;
  for(int i = 0; i < 256; ++i)
    every += static_cast<char>(i);
  for(std::size_t length = 1; length < 600; ++length) {
    const std::string data = every + std::string(length, length % 2 == 0 ? '\xf0' : 'x') + "end";
    REQUIRE(Inflater{Deflated_runs(data).bytes()}.text() == data);
  }
  CHECK(Inflater{Deflated_runs("").bytes()}.text() == "");
  CHECK(Deflated_runs(std::string(100000, '\0')).bytes().size() < 700);
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
              count(html, "<td class='best'>" + formatted(s.judgements[0].norms().norm_L) + "</td>") >=
          1);
    CHECK(count(html, ">" + formatted(s.judgements[0].norms().norm_D) + "</td>") >= 1);
  }
  CHECK(count(html, "a<b>") == 0);
  CHECK(count(html, "a&lt;b&gt;&amp;c.off") >= 2);
  CHECK(count(html, "<img ") == 4);
  CHECK(count(html, "<svg ") == count(html, "</svg>"));
  CHECK(count(html, "<table>") == count(html, "</table>"));
  CHECK(count(html, "<tr") == count(html, "</tr>"));
  CHECK(count(html, "<script") == 0);
  CHECK(count(html, "<link") == 0);
  CHECK(count(html, "src='http") == 0);
  CHECK(count(html, "url(") == 0);
  CHECK(count(html, "nan") == 0);
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
