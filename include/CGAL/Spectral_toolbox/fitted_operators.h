// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_TOOLBOX_FITTED_OPERATORS_H
#define CGAL_SPECTRAL_TOOLBOX_FITTED_OPERATORS_H

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_toolbox/internal/separate_compilation.h>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/*!
How `fit_operators()` chooses the entries of a coarse Laplacian and mass. All numbers are free of
scale; the defaults are those that were measured.
*/
struct Operator_fit_options : Run_control
{
  /// Where the mass has entries.
  enum class Mass_pattern {
    diagonal, ///< on the diagonal alone
    edges     ///< on the edges of the mesh as well
  };
  Mass_pattern mass = Mass_pattern::edges; ///< the choice among them
  /// Where the Laplacian has entries: 2, the pattern of L L, about 19 entries per row; 1, the edges
  /// of the mesh alone, where \f$ \|C\|_D \f$ gains nothing: what a single ring adds for high modes
  /// it takes from the eigenvalues of low ones.
  int rings = 2;
  /// e: the residual of signal k has the weight \f$ (\lambda_k + 4 \pi)^{-e} \f$. More favours
  /// distances and signatures, which live on the lowest modes; less the functional map. With 1 in
  /// place of 2.5 \f$ \|C\|_L \f$ is 0.83 times as large, and errors of biharmonic distances are
  /// 1.6 times, of diffusion distances 2.4 times as large (four meshes). From 0 to 20.
  double low_modes = 2.5;
  /// mu: weight of the orthonormality of the restricted eigenvectors beside commutativity. More
  /// lowers \f$ \|C\|_D \f$ and raises \f$ \|C\|_L \f$ and the errors of the eigenvalues; from 0.
  double orthonormality = 0.01;
  /// eta: weight of the whole residual beside the part of it that the functional map sees, the
  /// projection on the restricted eigenvectors. Less lowers \f$ \|C\|_L \f$, more keeps the modes
  /// beyond K; from 0.
  double whole_residual = 0.2;
  /// tau: weight of the mean squared change of an entry, relative to the entry and a typical one.
  /// Positive: it alone decides what the eigenvectors leave open.
  double regularization = 0.05;
  /// No edge weight falls below this part of its own value, nor of a twentieth of the median one:
  /// this keeps each component together. In ]0, 1].
  double smallest_weight = 0.02;
  /// No b_v falls below this part of the vertex' own row sum, or of a thousandth of the mean one
  /// where that is more. In ]0, 1].
  double smallest_mass = 0.01;

  /// Ends when gap and Newton decrement are below this part of the objective. In ]0, 1[.
  double tolerance = 0.05;
  /// Largest number of iterations, each of one factorisation and a few products; from 0.
  int maximum_iterations = 30;

  /// Returns options for a mass of the blend \f$ \theta \f$ of `laplace_operator()`: on the edges,
  /// or on the diagonal if it is lumped.
  static Operator_fit_options for_mass(double theta)
  {
    Operator_fit_options options;
    options.mass = theta == 0. ? Mass_pattern::diagonal : Mass_pattern::edges;
    return options;
  }
};

/// What `fit_operators()` found.
struct Operator_fit_result
{
  /// L, B, and the row sums of B; `theta` is that of the coarse operator, 0 for a diagonal mass
  Laplace_operator op;
  /// the objective for the mesh's own entries, brought inside of the bounds and to the total
  double objective_before = 0;
  double objective_after = 0; ///< and for those of `op`, never larger
  int iterations = 0;         ///< of the barrier method
  /// within `Operator_fit_options::tolerance`; otherwise stopped, and valid all the same
  bool converged = false;
  Eigen::Index unknowns = 0; ///< number of weights that were chosen
  Eigen::Index at_bound = 0; ///< and of those that ended at their lower bounds
};

/*!
chooses the entries of a Laplacian and a mass on a coarse mesh so that they have the eigenpairs of a
fine mesh as nearly as the sparsity allows: for functional maps, spectral distances and signatures,
which compute with operators and not with triangles. The result goes to `eigenpairs()`,
`evaluate_spectrum()` and whatever takes an operator. It is not for what needs the cotangents or the
areas of the actual triangles.

Let \f$ G = P \Phi \f$, D the lumped mass of the coarse mesh and \f$ R = \widetilde B G \Lambda -
\widetilde L G \f$, all at unit area. (Exceptions are vertices whose own mode \f$ L_{vv} / M_v \f$
is more than eight times the highest fitted eigenvalue and the median of all: there ten Gauss-Seidel
sweeps solve row v of \f$ L g = \lambda B g \f$ for G.) The function minimises
\f[ \|G^\top R\|_W^2 + \eta \|D^{-1/2} R\|_W^2 + \mu \|G^\top \widetilde B G - I\|^2
   + \frac{\tau}{N} \sum_a \left( \frac{x_a - x_a^0}{x_a^0 + s_a} \right)^2 \f]
where W weights the signals by \f$ (\lambda_k + 4\pi)^{-e} \f$, relative to \f$ \mathrm{mean}(W
\lambda^2) \f$: 4 pi is the mean spacing of eigenvalues at unit area (Weyl's law), and e = 2 would
ask for the same relative accuracy of all modes. The first term is \f$ \|C \Lambda -
\widetilde\Lambda C\| \f$ when G stands for the coarse eigenvectors, the second the metric E (Eq. 2
of Lescoat et al. 2020). The last term ties the unknowns x, N and more (the weights w, m, b below),
to their values \f$ x_a^0 \f$ for the mesh's own entries. \f$ s_a \f$ is the median weight of an
edge or the mean mass of a vertex, plus \f$ x_a^0 \f$ for a term of a thin triangle.

**Both matrices are definite, whatever the input.**
\f[ \widetilde L = \sum_a w_a \, d_a d_a^\top, \qquad
   \widetilde B = \sum_v b_v \, e_v e_v^\top + \sum_{ij} m_{ij} (e_i + e_j) (e_i + e_j)^\top, \qquad
w, m \ge 0, \; b > 0, \f]
with \f$ d_a = e_i - e_j \f$ for each edge and positive bounds on these,
so that \f$ \widetilde L \f$ has one zero for each connected component of the graph. An edge of
negative weight (an obtuse or thin triangle) lies in this cone together with the other two edges of
its triangles: \f$ d_a = e_k - (1-t) e_i - t e_j \f$ with k opposite to ij, as much as it needs. Two
rings add for each vertex of up to 64 neighbours its row of L, and for each edge between two
triangles \f$ d_a = e_i + e_j - e_k - e_l \f$, the second difference across it: these, not edges to
far vertices, make up for a diagonal mass. The total of the mass of each component is that of the
coarse mesh (an exact scaling of both matrices follows a penalty that leaves little to do).

This is a convex quadratic program with bounds. A primal-dual barrier method solves it from the
mesh's own entries on. Each step uses conjugate gradients: products are formed from signals (O(N
K^2)), and the Cholesky factor of the sparse normal matrix of the second term preconditions while it
serves. Time and memory are linear in N but for the fill-in of that factor. Whenever it stops, the
result is within the bounds, up to that scaling, and its objective not larger than that of the own
entries.

@param coarse operator of the coarse mesh. The entries of L off the diagonal give the pattern of
both matrices and the start of L, B the start of the mass; `mass` gives D and the total
@param P      restriction, coarse x fine
@param fine   operator of the fine mesh, of which only the area is used
@param fine_pairs its eigenpairs, orthonormal in its mass. A fifth more pairs than are judged
improve the modes beyond, and \f$ \|C\|_D \f$
@param options weights, bounds, pattern, when to stop

Throws `std::invalid_argument` with one sentence that names the first offender for matrices that do
not belong together, a number that is not finite, an option out of range; `std::runtime_error` when
a preconditioner cannot be factorised; `Cancelled` when it is cancelled.

References: the operator-based view is that of H.-T. D. Liu, A. Jacobson, M. Ovsjanikov, *Spectral
Coarsening of Geometric Operators*, 2019, and H. Chen et al., *Chordal Decomposition for Spectral
Coarsening*, 2020; the barrier method is in J. Nocedal, S. Wright, *Numerical Optimization*, 2006,
section 16.6.
*/
CGAL_SPECTRAL_TOOLBOX_INLINE Operator_fit_result
fit_operators(const Laplace_operator& coarse, const Eigen::SparseMatrix<double>& P,
              const Laplace_operator& fine, const Eigenpairs& fine_pairs,
              const Operator_fit_options& options = {});

/// @}

namespace internal {

/// Throws `std::invalid_argument` for an option out of range.
inline void check_operator_fit_options(const Operator_fit_options& o)
{
  require(o.rings == 1 || o.rings == 2, "operator fit: rings must be 1 or 2, but is ", o.rings,
          ".");
  require(o.orthonormality >= 0. && o.whole_residual >= 0. &&
              std::isfinite(o.orthonormality + o.whole_residual),
          "operator fit: orthonormality and whole_residual must be numbers from 0.");
  require(o.low_modes >= 0. && o.low_modes <= 20.,
          "operator fit: low_modes must be a number from 0 to 20.");
  require(o.regularization > 0. && std::isfinite(o.regularization),
          "operator fit: regularization must be a positive number.");
  require(o.smallest_weight > 0. && o.smallest_weight <= 1. && o.smallest_mass > 0. &&
              o.smallest_mass <= 1.,
          "operator fit: smallest_weight and smallest_mass must lie in ]0, 1].");
  require(o.tolerance > 0. && o.tolerance < 1.,
          "operator fit: tolerance must lie between 0 and 1.");
  require(o.maximum_iterations >= 0, "operator fit: maximum_iterations must not be negative.");
  require(o.threads >= 1, "operator fit: threads must be at least 1.");
}

} // namespace internal
} // namespace CGAL::Spectral_geometry

#if !defined(CGAL_SPECTRAL_TOOLBOX_COMPILED) || defined(CGAL_SPECTRAL_COMPILE_TOOLBOX)

#include <CGAL/Spectral_geometry/internal/numerics/Eigen_problem.h>
#include <CGAL/Spectral_geometry/internal/numerics/Supernodal_factor.h>
#include <CGAL/Spectral_toolbox/internal/fit_matrices.h>
#include <CGAL/Spectral_geometry/internal/numerics/for_each_task.h>
#include <CGAL/Spectral_geometry/internal/surface/connectivity.h>

#include <CGAL/number_type_config.h>

namespace CGAL::Spectral_geometry {
namespace internal {

/// The quadratic program of fit_operators() and its solver, at unit area.
class Operator_fit
{
  using Index = Eigen::Index;
  using Matrix = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;
  using Rows = Rank_one_terms::Rows;

public:
  Operator_fit(const Laplace_operator& own, const Matrix& G, Vector lambda,
               const Operator_fit_options& options)
    : m_options(options)
    , m_G(G)
    , m_lambda(std::move(lambda))
    , m_area(own.mass.sum())
    , m_row_mass((own.mass / m_area).cwiseMax(1e-3 / G.rows()))
    , m_weight(
          (m_lambda.array() + 4 * CGAL_PI * (own.has_coefficients ? unit_of_stiffness(own.L) : 1.))
              .pow(-options.low_modes))
  {
    const double mean = (m_weight.array() * m_lambda.array().square()).mean();
    m_weight *= mean > 0. ? 1. / mean : 0.; // 0 where all eigenvalues are
    collect_terms(own);
    const Index nL = m_stiffness.size(), n = nL + m_mass.size();
    Eigen::MatrixX3d ranges(n, 3);
    ranges << m_stiffness.ranges(), m_mass.ranges();
    m_start = ranges.col(0);
    m_lowest = ranges.col(1);
    m_typical = ranges.col(2);
    m_total = Vector::Zero(n);
    m_total.tail(n - nL) = (m_mass.vectors() * Vector::Ones(G.rows())).cwiseAbs2();
    find_components(own);
    m_regularization =
        (m_start + m_typical).cwiseAbs2().cwiseInverse() * (options.regularization / G.rows());
    assemble_normal_matrix(G);
  }

  Operator_fit_result run()
  {
    Operator_fit_result result;
    const Index n = m_start.size(), nL = m_stiffness.size();
    Vector g;
    const Vector own = scaled(m_start);
    result.objective_before = evaluate(own, g);
    // Slacks s and multipliers z, both positive; g is half the gradient.
    Vector s = (m_start - m_lowest).cwiseMax(0.01 * m_typical);
    double f = evaluate(m_lowest + s, g);
    Vector z = (0.1 * f / n) * s.cwiseInverse();
    while(!result.converged && result.iterations < m_options.maximum_iterations) {
      report_to(m_options,
                {Phase::operator_fit, result.iterations / double(m_options.maximum_iterations)});
      const Vector barrier = z.cwiseQuotient(s), target = (0.2 * s.dot(z) / n) * s.cwiseInverse();
      Vector dx, Qdx;
      const double newton = newton_step(target - g, barrier, dx, Qdx);
      const Vector dz = target - z - barrier.cwiseProduct(dx);
      const double primal = step_inside(s, dx), dual = step_inside(z, dz);
      f += 2. * primal * g.dot(dx) + primal * primal * Qdx.dot(dx);
      s += primal * dx;
      g += primal * Qdx;
      z += dual * dz;
      ++result.iterations;
      result.converged = (std::max)(s.dot(z), newton) <= m_options.tolerance * f;
    }
    Vector x = m_lowest + s;
    result.at_bound = ((x - m_lowest).array() <= 1e-3 * m_typical.array()).count();
    x = scaled(x);
    result.objective_after = evaluate(x, g);
    if(!(result.objective_after < result.objective_before)) {
      x = own;
      result.objective_after = result.objective_before;
    }
    result.unknowns = n;
    result.op.L = m_stiffness.matrix(x.head(nL));
    result.op.B = m_area * m_mass.matrix(x.tail(n - nL));
    result.op.mass = result.op.B * Vector::Ones(m_row_mass.size());
    return result;
  }

private:
  // Which unknowns belong to which component of the mesh, and what is its share of the area.
  void find_components(const Laplace_operator& own)
  {
    const Index N = m_row_mass.size();
    const std::vector<Index> component = connected_components(N, [&](const auto& join) {
      for(Index j = 0; j < N; ++j)
        for(Sparse_matrix::InnerIterator it(own.L, j); it; ++it)
          join(it.row(), j);
    });
    m_share = Vector::Zero(*std::max_element(component.begin(), component.end()) + 1);
    for(Index v = 0; v < N; ++v)
      m_share(component[v]) += own.mass(v) / m_area;
    for(const Rank_one_terms* terms : {&m_stiffness, &m_mass})
      for(Index a = 0; a < terms->size(); ++a)
        m_component.push_back(
            component[Rank_one_terms::Sparse_rows::InnerIterator(terms->vectors(), a).col()]);
  }

  // The mass of each component.
  Vector totals(const Vector& x) const
  {
    Vector result = Vector::Zero(m_share.size());
    for(Index a = 0; a < x.size(); ++a)
      result(m_component[a]) += m_total(a) * x(a);
    return result;
  }

  // The number of its component for each unknown.
  Vector spread(const Vector& of_components) const
  {
    return Vector::NullaryExpr(m_start.size(),
                               [&](Index a) { return of_components(m_component[a]); });
  }

  // Gives each component the mass that it has. Otherwise components that fit badly would shrink,
  // which lowers their residual.
  Vector scaled(const Vector& x) const
  {
    return x.cwiseProduct(spread(m_share.cwiseQuotient(totals(x))));
  }

  struct Edge
  {
    Index i, j;
    double weight, mass;
    std::vector<Index> opposite; // common neighbours of i and j
    int leaning = 0;             // number of negative edges that lean on this one
    double remaining = 0.;       // what they leave of its weight
  };

  void collect_terms(const Laplace_operator& own)
  {
    const Index N = m_row_mass.size();
    const bool diagonal = m_options.mass == Operator_fit_options::Mass_pattern::diagonal;
    std::vector<Edge> edges;
    std::vector<std::vector<std::pair<Index, Index>>> rings(N); // neighbour and edge, ascending
    std::vector<double> sizes;
    for(Index j = 0; j < N; ++j)
      for(Sparse_matrix::InnerIterator it(own.L, j); it; ++it)
        if(it.row() < j) {
          rings[it.row()].push_back({j, static_cast<Index>(edges.size())});
          rings[j].push_back({it.row(), static_cast<Index>(edges.size())});
          edges.push_back({it.row(), j, -it.value(), own.B.coeff(it.row(), j) / m_area, {}});
          sizes.push_back(std::abs(it.value()));
        }
    const double median_size = median(Vector::Map(sizes.data(), Index(sizes.size()))),
                 scale = median_size > 0. ? median_size : 1.;
    const double largest = 1e3 * scale;
    const auto edge = [&](Index a, Index b) { // or null
      const auto found =
          std::lower_bound(rings[a].begin(), rings[a].end(), std::make_pair(b, Index(0)));
      return found != rings[a].end() && found->first == b ? &edges[found->second] : nullptr;
    };
    for(Edge& e : edges) {
      e.weight = e.remaining = (std::min)((std::max)(e.weight, -largest), largest);
      const auto [few, many] =
          rings[e.i].size() < rings[e.j].size() ? std::pair(e.i, e.j) : std::pair(e.j, e.i);
      for(const auto& r : rings[few])
        if(edge(many, r.first))
          e.opposite.push_back(r.first);
      if(e.weight < 0.)
        for(const Index k : e.opposite) {
          ++edge(e.i, k)->leaning;
          ++edge(e.j, k)->leaning;
        }
    }
    for(Edge& e : edges)
      if(e.weight < 0.)
        add_thin_triangles(e, edge, scale);

    Vector b = (diagonal ? own.mass : Vector(own.B.diagonal())) / m_area;
    for(const Edge& e : edges) {
      m_stiffness.add({{e.i, 1.}, {e.j, -1.}}, e.remaining,
                      m_options.smallest_weight * (std::max)(scale * 0.05, e.remaining), scale);
      if(m_options.rings == 2 && e.opposite.size() == 2)
        m_stiffness.add({{e.i, 1.}, {e.j, 1.}, {e.opposite[0], -1.}, {e.opposite[1], -1.}}, 0., 0.,
                        scale);
      if(!diagonal) {
        m_mass.add({{e.i, 1.}, {e.j, 1.}}, e.mass, 0., 1. / N);
        b(e.i) -= e.mass;
        b(e.j) -= e.mass;
      }
    }
    for(Index v = 0; v < N; ++v) {
      m_mass.add({{v, 1.}}, b(v), m_options.smallest_mass * m_row_mass(v), 1. / N);
      if(m_options.rings == 2 && !rings[v].empty() && Index(rings[v].size()) <= largest_star) {
        Rank_one_terms::Entries star{{v, 0.}};
        double sum = 0.;
        for(const auto& r : rings[v])
          sum += std::abs(edges[r.second].weight) + 1e-3 * scale;
        for(const auto& r : rings[v]) {
          const double w = 2. * edges[r.second].weight / sum;
          star.push_back({r.first, -w});
          star[0].second += w;
        }
        m_stiffness.add(star, 0., 0., scale);
      }
    }
    m_stiffness.assemble(N);
    m_mass.assemble(N);
  }

  // w_ij < 0, with a = w_ik > 0 and b = w_jk > 0: q (e_k - (1-t) e_i - t e_j)(...)^T with t = b /
  // (a + b) and q <= a + b has q t (1-t) at ij, up to a b / (a + b), and takes q (1-t) from a, q t
  // from b. a or b may be next to nothing.
  template <class Find>
  void add_thin_triangles(Edge& e, const Find& edge, double scale)
  {
    double capacity = 0.;
    std::vector<std::tuple<double, double, Index>> shares; // a, b, k
    for(const Index k : e.opposite) {
      const Edge &ik = *edge(e.i, k), &jk = *edge(e.j, k);
      const double a = (std::max)(ik.weight, 0.) / ik.leaning,
                   b = (std::max)(jk.weight, 0.) / jk.leaning;
      if(a > 0. && b > 0.) {
        shares.emplace_back(a, b, k);
        capacity += a * b / (a + b);
      }
    }
    const double part = capacity > 0. ? (std::min)(1., -e.weight / capacity) : 0.;
    for(const auto& [a, b, k] : shares) {
      const double q = part * (a + b), t = b / (a + b);
      m_stiffness.add({{k, 1.}, {e.i, t - 1.}, {e.j, -t}}, q, 0., scale + q);
      edge(e.i, k)->remaining -= q * (1. - t);
      edge(e.j, k)->remaining -= q * t;
      e.remaining += q * t * (1. - t);
    }
  }

  // The lower triangle of H = sum_v A_v A_v^T / D_v, where row v of R, times the root of W, is
  // A_v^T x. It only preconditions: for a vertex with very many unknowns in its row the diagonal is
  // enough.
  void assemble_normal_matrix(const Rows& G)
  {
    const Index nL = m_stiffness.size();
    const Sparse_matrix DL = m_stiffness.vectors(), DB = m_mass.vectors();
    const Eigen::RowVectorXd of_stiffness = -m_weight.cwiseSqrt().transpose(),
                             of_mass = -of_stiffness.cwiseProduct(m_lambda.transpose());
    std::vector<Eigen::Triplet<double>> lower;
    std::vector<Index> unknowns;
    for(Index v = 0; v < G.rows(); ++v) {
      Rows A(DL.col(v).nonZeros() + DB.col(v).nonZeros(), G.cols());
      unknowns.clear();
      for(Sparse_matrix::InnerIterator d(DL, v); d; ++d) {
        A.row(unknowns.size()) = d.value() * m_stiffness.row(d.row(), G).cwiseProduct(of_stiffness);
        unknowns.push_back(d.row());
      }
      for(Sparse_matrix::InnerIterator d(DB, v); d; ++d) {
        A.row(unknowns.size()) = d.value() * m_mass.row(d.row(), G).cwiseProduct(of_mass);
        unknowns.push_back(nL + d.row());
      }
      if(A.rows() > largest_block) {
        for(Index j = 0; j < A.rows(); ++j)
          lower.emplace_back(static_cast<int>(unknowns[j]), static_cast<int>(unknowns[j]),
                             A.row(j).squaredNorm() / m_row_mass(v));
        continue;
      }
      const Matrix S = A * A.transpose() / m_row_mass(v);
      for(Index j = 0; j < S.cols(); ++j)
        for(Index i = j; i < S.rows(); ++i)
          lower.emplace_back(static_cast<int>(unknowns[i]), static_cast<int>(unknowns[j]), S(i, j));
    }
    m_H.resize(m_start.size(), m_start.size());
    m_H.setFromTriplets(lower.begin(), lower.end());
  }

  // The objective and half its gradient; or, for a direction, Q x. Two passes over the rows of G,
  // by blocks that stay in the cache.
  double evaluate(const Vector& x, Vector& g, bool affine = true)
  {
    const Index nL = m_stiffness.size(), nB = m_mass.size(), K = m_lambda.size(),
                panels = m_G.panels();
    const Sparse_matrix L = m_stiffness.matrix(x.head(nL)), B = m_mass.matrix(x.tail(nB));
    Panel_matrix R(m_row_mass.size(), K), lambda(m_lambda.transpose()),
        weight(m_weight.transpose());
    struct Sums
    {
      Panel_matrix GBG, GLG;
      double f;
    };
    const Panel_matrix zeros(panels * panel_width, K);
    std::vector<Sums> sums(number_of_ranges(), {zeros, zeros, 0.});
    for_each_block([&](Index range, Index first, Index rows, Panel_matrix& BG, Panel_matrix& LG) {
      Sums& sum = sums[range];
      for(Index q = 0; q < panels; ++q) {
        for(const auto& product : {std::make_pair(&B, &BG), std::make_pair(&L, &LG)})
          multiply(product.first->outerIndexPtr() + first, product.first->innerIndexPtr(),
                   product.first->valuePtr(), m_G.row(q, 0), product.second->row(q, 0), 0, rows);
        for(Index p = 0; p <= q; ++p) {
          gram(m_G.row(p, first), BG.row(q, 0), rows, sum.GBG.block(p, q));
          gram(m_G.row(p, first), LG.row(q, 0), rows, sum.GLG.block(p, q));
        }
        auto E = R.rows(q, first, rows);
        E = BG.rows(q, 0, rows).rowwise() * lambda.numbers(q) - LG.rows(q, 0, rows);
        const auto W = weight.numbers(q);
        const auto row_weight = m_options.whole_residual / m_row_mass.segment(first, rows).array();
        if(affine)
          sum.f += ((E.square().rowwise() * W).rowwise().sum() * row_weight).sum();
        E = ((E.rowwise() * W).colwise() * row_weight).eval();
      }
    });
    Matrix T = Matrix::Zero(K, K), S = T;
    double f = 0.;
    for(Sums& sum : sums) {
      sum.GBG.add_upper_to(T);
      sum.GLG.add_upper_to(S);
      f += sum.f;
    }
    for(Matrix* symmetric : {&T, &S})
      symmetric->triangularView<Eigen::StrictlyLower>() = symmetric->transpose();
    const Matrix X = T * m_lambda.asDiagonal() - S;
    if(affine)
      T.diagonal().array() -= 1.;
    const Vector total = (affine ? Vector(totals(x) - m_share) : totals(x)).cwiseQuotient(m_share);
    const Vector change = affine ? Vector(x - m_start) : x;
    if(affine)
      f += (X.cwiseAbs2() * m_weight).sum() + m_options.orthonormality * T.squaredNorm() +
           penalty * total.cwiseAbs2().dot(m_share) + change.cwiseAbs2().dot(m_regularization);
    Panel_matrix of_L(-X * m_weight.asDiagonal()), of_B(-m_options.orthonormality * T);
    Vector by_L(L.nonZeros()), by_B(B.nonZeros());
    for_each_block([&](Index, Index first, Index rows, Panel_matrix& A, Panel_matrix&) {
      const auto add_product_of_G = [&](Panel_matrix& minus_M, Index q) {
        for(Index p = 0; p < panels; ++p)
          subtract_product(A.row(q, 0), m_G.row(p, first), rows, minus_M.block(p, q));
      };
      for(Index q = 0; q < panels; ++q) {
        A.rows(q, 0, rows) = R.rows(q, first, rows);
        add_product_of_G(of_L, q);
      }
      sampled_product(L, first, rows, A, m_G, by_L.data());
      for(Index q = 0; q < panels; ++q) {
        A.rows(q, 0, rows).rowwise() *= lambda.numbers(q);
        add_product_of_G(of_B, q);
      }
      sampled_product(B, first, rows, A, m_G, by_B.data());
    });
    g.resize(x.size());
    g.head(nL) = -m_stiffness.derivatives(by_L);
    g.tail(nB) = m_mass.derivatives(by_B);
    g += penalty * m_total.cwiseProduct(spread(total)) + m_regularization.cwiseProduct(change);
    return f;
  }

  // Ranges of rows whose sums are formed apart, however many threads there are.
  Index number_of_ranges() const { return (std::min)(Index(8), 1 + m_row_mass.size() / 512); }

  // Calls f(range, first row, number of rows, scratch, scratch) for blocks of rows, those of a
  // range in order.
  template <class Function>
  void for_each_block(const Function& f)
  {
    const Index N = m_row_mass.size(), ranges = number_of_ranges();
    for_each_task(ranges, m_options.threads, [&](const Index range) {
      const Index end = N * (range + 1) / ranges;
      Panel_matrix first_scratch(rows_of_block, m_lambda.size()), second_scratch = first_scratch;
      for(Index first = N * range / ranges; first < end; first += rows_of_block)
        f(range, first, (std::min)(rows_of_block, end - first), first_scratch, second_scratch);
    });
  }

  // Conjugate gradients for (Q + barrier) dx = r, to a tenth in the norm of the preconditioner (eta
  // + 1/10) H + regularization + barrier + penalty; returns the square of that norm of r.
  double newton_step(Vector r, const Vector& barrier, Vector& dx, Vector& Qdx)
  {
    Vector y(r.size()), q, p;
    if(m_steps > 5) { // products are cheaper than a factorisation
      Sparse_matrix M = (m_options.whole_residual + 0.1) * m_H;
      // It stays definite after rounding, too.
      M.diagonal() += m_regularization + barrier + 1e-10 * M.diagonal();
      if(m_cholesky)
        m_cholesky->factorise(M, m_options.threads);
      else
        m_cholesky = std::make_unique<Supernodal_factor>(M, m_options.threads);
      m_solved_total = m_cholesky->solve(m_total, m_options.threads);
      // one term for each component, and none in common
      m_rank_one = penalty * (m_share + penalty * totals(m_solved_total)).cwiseInverse();
    }
    dx = Qdx = Vector::Zero(r.size());
    double first = 0., last = 0.;
    for(m_steps = 0; m_steps < 20; ++m_steps) {
      y = m_cholesky->solve(r, m_options.threads);
      y -= m_solved_total.cwiseProduct(spread(m_rank_one.cwiseProduct(totals(y))));
      const double next = r.dot(y);
      if(m_steps == 0)
        first = next;
      if(!(next > 0.01 * first))
        break;
      p = m_steps == 0 ? y : Vector(y + (next / last) * p);
      last = next;
      evaluate(p, q, false);
      const Vector Mp = q + barrier.cwiseProduct(p);
      const double step = next / p.dot(Mp);
      dx += step * p;
      Qdx += step * q;
      r -= step * Mp;
    }
    return first;
  }

  // The part of a step, at most 1, that leaves a twentieth of each entry at least.
  static double step_inside(const Vector& v, const Vector& dv)
  {
    return 1. / (std::max)(1., (-dv.cwiseQuotient(v)).maxCoeff() / 0.95);
  }

  // Limits that keep the cost linear in the degree of a vertex: a second ring of more neighbours is
  // left out, and a block of more unknowns in the preconditioner is diagonal.
  static constexpr Index largest_star = 64, largest_block = 256;
  static constexpr Index rows_of_block = 128;
  // of the totals of the mass; the other terms are about 1 or less
  static constexpr double penalty = 1e4;
  const Operator_fit_options& m_options;
  Panel_matrix m_G;
  const Vector m_lambda;
  const double m_area;
  const Vector m_row_mass;
  Vector m_weight, m_start, m_lowest, m_typical, m_total, m_regularization, m_share;
  std::vector<Index> m_component; // of each unknown
  Rank_one_terms m_stiffness, m_mass;
  Sparse_matrix m_H;
  std::unique_ptr<Supernodal_factor> m_cholesky; // of a recent preconditioner
  Vector m_solved_total;                         // its solution for m_total
  Vector m_rank_one;
  int m_steps = 1000; // of conjugate gradients, the last time
};

// The own mode of a vertex is the diagonal of L over the mass. Where it lies far above the fitted
// eigenvalues and the own modes of other vertices, the neighbours give the value of each fitted
// mode: ten Gauss-Seidel sweeps solve row v of L g = lambda B g. P may read another sheet there, as
// in a pocket of the surface; fitted to it, the vertex' mode would come down among the fitted ones.
inline void settle_remote_vertices(const Laplace_operator& own, const Eigen::VectorXd& lambda,
                                   Eigen::MatrixXd& G)
{
  const Eigen::RowVectorXd scaled = lambda.transpose() / own.mass.sum();
  const Eigen::VectorXd mode = own.mass.sum() * own.L.diagonal().cwiseQuotient(own.mass);
  const double remote = 8. * (std::max)(lambda.maxCoeff(), median(mode));
  for(int sweep = 0; sweep < 10; ++sweep)
    for(Eigen::Index v = 0; v < mode.size(); ++v) {
      if(!(mode(v) > remote))
        continue;
      const Eigen::RowVectorXd diagonal = own.L.coeff(v, v) - own.B.coeff(v, v) * scaled.array();
      if(!(diagonal.minCoeff() > 0.))
        continue;
      G.row(v).setZero(); // what is left are its neighbours
      const Eigen::RowVectorXd L = own.L.col(v).transpose() * G, B = own.B.col(v).transpose() * G;
      G.row(v) = (B.cwiseProduct(scaled) - L).cwiseQuotient(diagonal);
    }
}

inline void check_operator_fit(const Laplace_operator& coarse, const Eigen::SparseMatrix<double>& P,
                               const Laplace_operator& fine, const Eigenpairs& pairs)
{
  const Eigen::Index N = P.rows(), n = P.cols(), K = pairs.size();
  require(N > 0 && coarse.L.rows() == N && coarse.L.cols() == N && coarse.B.rows() == N &&
              coarse.B.cols() == N && coarse.mass.size() == N,
          "operator fit: P is ", size_name(P), " but the coarse operator has L ",
          size_name(coarse.L), ", B ", size_name(coarse.B), " and ", coarse.mass.size(),
          " masses, pass matrices of one coarse mesh.");
  require(fine.mass.size() == n && pairs.vectors.rows() == n && pairs.vectors.cols() == K && K > 0,
          "operator fit: P is ", size_name(P), " but there are ", fine.mass.size(),
          " fine masses, ", K, " eigenvalues and eigenvectors of ", size_name(pairs.vectors),
          ", pass the operator and at least one eigenpair of the fine mesh.");
  require(coarse.boundary == Boundary_condition::neumann &&
              fine.boundary == Boundary_condition::neumann,
          "operator fit: the rows of a fitted Laplacian sum to zero, which those of the Dirichlet "
          "condition do not; pass operators without it.");
  for(Eigen::Index v = 0; v < N; ++v)
    require(coarse.mass(v) > 0. && std::isfinite(coarse.mass(v)), "operator fit: the mass of ",
            vertex_name(v), " of the coarse mesh is not a positive number.");
  const double area = fine.mass.sum();
  require(area > 0. && std::isfinite(area),
          "operator fit: the area of the fine mesh is not a positive number.");
  // What rounding leaves of an eigenvalue that is zero.
  const double rounding = 1e-6 * pairs.values.cwiseAbs().maxCoeff();
  for(Eigen::Index k = 0; k < K; ++k)
    require(pairs.values(k) >= -rounding && std::isfinite(pairs.values(k)) &&
                pairs.vectors.col(k).allFinite(),
            "operator fit: eigenpair ", k,
            " (counted from 0) has a number that is negative or not finite.");
  const auto check_entries = [&](const Eigen::SparseMatrix<double>& A, const char* name) {
    for(Eigen::Index j = 0; j < A.outerSize(); ++j)
      for(Eigen::SparseMatrix<double>::InnerIterator it(A, j); it; ++it)
        require(std::isfinite(it.value()), "operator fit: entry ", it.row(), ", ", it.col(),
                " (counted from 0) of ", name, " is not a finite number.");
  };
  check_rows_of_restriction("operator fit: ", P);
  check_entries(coarse.L, "the coarse L");
  check_entries(coarse.B, "the coarse B");
}

} // namespace internal

Operator_fit_result fit_operators(const Laplace_operator& coarse,
                                  const Eigen::SparseMatrix<double>& P,
                                  const Laplace_operator& fine, const Eigenpairs& fine_pairs,
                                  const Operator_fit_options& options)
{
  internal::check_operator_fit_options(options);
  internal::check_operator_fit(coarse, P, fine, fine_pairs);
  const double area = fine.mass.sum();
  const Eigen::VectorXd lambda = area * fine_pairs.values.cwiseMax(0.);
  Eigen::MatrixXd G = std::sqrt(area) * (P * fine_pairs.vectors);
  internal::settle_remote_vertices(coarse, lambda, G);
  Operator_fit_result result;
  try {
    result = internal::Operator_fit(coarse, G, lambda, options).run();
  } catch(const internal::Not_positive_definite&) { // whose sentence is that of the eigensolvers
    throw std::runtime_error(
        "operator fit: the preconditioner could not be factorised; look for needle faces in the "
        "coarse mesh, or raise Operator_fit_options::regularization.");
  }
  result.op.theta =
      options.mass == Operator_fit_options::Mass_pattern::diagonal ? 0. : coarse.theta;
  return result;
}

} // namespace CGAL::Spectral_geometry

#endif // definitions

#endif // CGAL_SPECTRAL_TOOLBOX_FITTED_OPERATORS_H
