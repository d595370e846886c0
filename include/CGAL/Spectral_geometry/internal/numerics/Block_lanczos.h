// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_BLOCK_LANCZOS_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_BLOCK_LANCZOS_H

#include <CGAL/Spectral_geometry/Eigenpairs_options.h>
#include <CGAL/Spectral_geometry/internal/numerics/Eigen_problem.h>
#include <CGAL/Spectral_geometry/internal/numerics/Panel_space.h>
#include <CGAL/Spectral_geometry/internal/numerics/Supernodal_factor.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <random>

namespace CGAL::Spectral_geometry::internal {

// The number of eigenvalues below a gap minus the number found. The gap lies below the group that
// the K-th value belongs to: copies of values(K-1) itself need not be counted, any K of them are
// right. A factorisation without pivoting can be wrong next to an eigenvalue of a leading block.
// Another shift in the gap avoids that; -1 if none does.
inline Index count_missing(const Eigen_problem& problem, const Eigen::VectorXd& values, int threads)
{
  const double s = problem.shift();
  Index k = values.size() - 1; // values below the gap
  while(k > 0 && !(values(k) - values(k - 1) > 1e-5 * (values(k) + s)))
    --k;
  const double lower = k > 0 ? values(k - 1) : -s;
  for(const double t : {0.5, 0.375, 0.59375}) {
    const double mu = lower + t * (values(k) - lower);
    if(mu < 0.)
      return 0; // L is positive semidefinite
    const Index missing = number_of_negative_eigenvalues(problem.shifted(mu), threads) - k;
    if(missing >= 0)
      return missing;
  }
  return -1;
}

/// Block Lanczos with shift and invert, thick restart and partial reorthogonalisation.
///
/// The operator is S = s (L - sigma B)^-1 B with eigenvalues theta = s / (lambda - sigma), the
/// inner product s B, with the mean spacing s of the eigenvalues. Eight vectors at a time share
/// each access to the factor and to the basis, and find up to eight copies of a multiple
/// eigenvalue. S V = V T + W E^T, where T is block tridiagonal (with an arrow after a restart).
///
/// The eigenvalues below a shift inside of the wanted spectrum, see `eigenpairs()`, have negative
/// theta; with sigma = -s no theta is negative. See Golub and Underwood 1977, Grimes, Lewis and
/// Simon 1994, Wu and Simon 2000.
///
/// Small matrices are MatrixXd, and products have such factors, not expressions: each further type
/// is compiled by itself.
class Block_lanczos
{
public:
  Block_lanczos(const Eigen_problem& problem, Index K, const Eigenpairs_options& options)
    : m_problem(problem)
    , m_K(K)
    , m_options(options)
    , m_inside(K >= 2 * panel_width && options.maximum_vectors == 0)
    , m_sigma((m_inside ? place_of_shift * K : -1.) * problem.shift())
    , m_factor(problem.shifted(m_sigma), options.threads, Supernodal_factor::Pivots::of_either_sign)
    , m_space(problem.shift() * permuted(problem.B(), m_factor.order()), options.threads)
    , m_W(problem.size())
    , m_BW(problem.size())
    , m_BV(problem.size())
  {
    // A larger space than one that needs no restart costs memory, a smaller one more solves.
    const Index standard = (std::max)(K * 36 / 10, K + 120);
    const Index limit = options.maximum_vectors > 0 ? options.maximum_vectors : standard;
    m_maximum_panels = (std::min)(limit, problem.size() - 2 * panel_width) / panel_width;
  }

  Eigenpairs compute()
  {
    bool found = false;
    for(int attempt = 0; m_inside && attempt < 3 && shift_inside(); ++attempt) {
      found = find_pairs();
      if(found || m_norm < largest_norm)
        break;
      m_sigma += 0.4 * m_problem.shift(); // there is an eigenvalue next to it
    }
    if(found && !(is_to_be_counted() && missing() > 0))
      return pairs();
    shift_below();
    find_pairs();
    if(is_to_be_counted())
      find_missing();
    return pairs();
  }

  // The one that was used.
  double shift() const { return m_sigma; }

  // --- a slice of the spectrum, see Spectrum_slices ---

  // Factorises L - sigma B and counts the eigenvalues below sigma; -1 where solves would lose too
  // many digits. Far up more of them may be lost, as residuals are relative to lambda.
  Index count_below(double sigma)
  {
    m_sigma = sigma;
    factorise();
    return solves_well(1e-13 + 1e-14 * sigma / m_problem.shift())
               ? m_factor.number_of_negative_pivots()
               : -1;
  }

  // Finds the K pairs next to the shift, `below` of them below it.
  bool find_next_to_shift(Index below, Index K)
  {
    m_below = below;
    m_K = K;
    return find_pairs();
  }

  Eigen::VectorXd values() const { return lambda().cwiseMax(0.); }

  // Returns the Ritz vectors X in the order of the mesh, orthonormal in B instead of s B. Destroys
  // the basis. Each vector becomes S X / theta = X + W link / theta (Ericsson and Ruhe 1980): L
  // would amplify the components of X along the highest modes.
  Eigenpairs pairs()
  {
    Eigen::MatrixXd C = links(0, m_K) * m_theta.head(m_K).cwiseInverse().asDiagonal();
    const Eigen::VectorXd further = further_values();
    make_orthonormal(C);
    compress(rounded_up(m_K));
    // Before memory for the result is taken.
    m_basis.erase(m_basis.begin() + m_panels, m_basis.end());
    for(Index k = 0; k < m_K; k += panel_width) {
      const Index columns = (std::min)(m_K - k, Index(panel_width));
      Eigen::MatrixXd minus_C = Eigen::MatrixXd::Zero(panel_width, panel_width);
      minus_C.leftCols(columns) = -C.middleCols(k, columns);
      m_space.subtract(m_basis[k / panel_width], m_W, minus_C);
    }
    Eigenpairs result{lambda(), Eigen::MatrixXd(m_problem.size(), m_K), {}, "block", m_complete};
    result.further_values = further;
    const double scale = std::sqrt(m_problem.shift());
    for_each_task(static_cast<int>(m_K), m_options.threads, [&](int k) {
      const Panel& panel = m_basis[k / panel_width];
      for(Index i = 0; i < m_space.size(); ++i)
        result.vectors(m_factor.order()[i], k) = scale * panel.row(i)[k % panel_width];
    });
    return result;
  }

private:
  static Index rounded_up(Index k) { return (k + panel_width - 1) / panel_width * panel_width; }
  Index dimension() const { return m_panels * panel_width; }

  // --- the shift ---

  void factorise()
  {
    m_problem.report(0.);
    if(m_factorised != m_sigma)
      m_factor.factorise(m_problem.shifted(m_sigma), m_options.threads);
    m_factorised = m_sigma;
  }

  // Moves the shift until about six tenths of the wanted eigenvalues are below it. False where that
  // cannot be done.
  bool shift_inside()
  {
    for(int attempt = 0; attempt < 5; ++attempt) {
      factorise();
      m_below = m_factor.number_of_negative_pivots();
      const double place = double(m_below) / double(m_K);
      const bool good = place > 0.4 && place < 0.75;
      if(good && solves_well())
        return true;
      m_sigma *= good || m_below < 0
                     ? 1.02
                     : (std::min)(32., (std::max)(1. / 32., place_of_shift / place));
    }
    return false;
  }

  void shift_below()
  {
    m_inside = false;
    m_below = 0;
    m_sigma = -m_problem.shift();
    factorise();
    if(m_factor.number_of_negative_pivots() != 0) {
      refuse_indefinite(m_problem, m_options.threads);
      throw Not_positive_definite();
    }
  }

  // A factorisation without pivoting loses digits next to an eigenvalue of a leading block: all but
  // two or three are to be there.
  bool solves_well(const double loss = 1e-13)
  {
    const Eigen::SparseMatrix<double> A = m_problem.shifted(m_sigma);
    const Eigen::VectorXd b = A.diagonal(), x = m_factor.solve(b, m_options.threads);
    return (A * x - b).norm() < loss * b.cwiseAbs().maxCoeff() * x.norm();
  }

  // --- the Krylov space ---

  // False where the shift is inside and of no use, see `iterate()`.
  bool find_pairs()
  {
    m_T.setZero(m_maximum_panels * panel_width, m_maximum_panels * panel_width);
    m_panels = 0;
    m_norm = 1.;
    m_random.seed(1);
    add_random_panel();
    return iterate(rounded_up(m_K + (std::max)(m_K / 2, 3 * Index(panel_width))));
  }

  // The next panel, without a link to those before it.
  void add_random_panel()
  {
    for(Index i = 0; i < m_space.size(); ++i)
      std::generate_n(m_W.row(i), panel_width, [&] { return random_entry(); });
    m_factor.solve(m_W, m_W, m_options.threads); // smooth vectors are a better start
    orthogonalise();
    orthogonalise();
    orthonormalise();
    m_link.setZero();
    m_loss = 1.; // let the next step reorthogonalise
    push_panel();
  }

  void push_panel()
  {
    if(static_cast<Index>(m_basis.size()) == m_panels)
      m_basis.emplace_back(m_problem.size());
    std::swap(m_basis[m_panels], m_W);
    ++m_panels;
  }

  // One step: applies S to the last panel. T grows by its products with the basis, m_W becomes the
  // next panel.
  void step()
  {
    const Index j = m_panels - 1, row = j * panel_width;
    std::swap(m_BV, m_BW); // left by orthonormalise()
    m_factor.solve(m_BV, m_W, m_options.threads);
    const Eigen::MatrixXd A = m_space.product(m_BV, m_W); // V_j^T (s B) S V_j
    m_space.subtract(m_W, m_basis[j], A);
    if(m_after_restart)
      orthogonalise();
    else if(j > 0)
      m_space.subtract(m_W, m_basis[j - 1], m_link.transpose());
    m_after_restart = false;
    m_T.block(row, row, panel_width, panel_width) = 0.5 * (A + A.transpose());

    // Rounding errors along converged vectors grow in each step by theta divided by the smallest
    // singular value of the link. At the square root of the machine precision T would lose digits
    // (Simon 1984). At a bound well below it the last two panels are reorthogonalised in one pass
    // over the basis: in every third or fourth step.
    if(m_loss > (m_inside ? 1e-12 : 1e-11) || m_locked) {
      orthogonalise(m_panels - 1);
      m_loss = std::numeric_limits<double>::epsilon();
    }
    orthonormalise();
    if(m_inside)
      m_norm = (std::max)(m_norm, std::hypot(A.norm(), m_link.norm()));
    m_loss *= m_norm / smallest_singular_value(m_link);
  }

  // Links the next panel to the last one.
  void advance()
  {
    const Index row = (m_panels - 1) * panel_width;
    m_T.block(row + panel_width, row, panel_width, panel_width) = m_link;
    m_T.block(row, row + panel_width, panel_width, panel_width) = m_link.transpose();
    push_panel();
  }

  // Orthogonalises the next panel against the basis, and in the same pass the last panel against
  // the first `before_last` panels.
  void orthogonalise(Index before_last = 0)
  {
    if(m_panels == 0)
      return;
    m_space.multiply_mass(m_W, m_BW);
    Coefficients H, H_last;
    m_space.products(m_basis.data(), m_panels, m_BW, H, before_last, m_BV, H_last);
    m_space.subtract(m_basis.data(), m_panels, m_W, H, before_last, m_basis[m_panels - 1], H_last);
  }

  // W = Q R by Cholesky, twice; m_link = R, m_BW = s B Q.
  void orthonormalise()
  {
    m_link.setIdentity(panel_width, panel_width);
    m_rank = panel_width;
    m_space.multiply_mass(m_W, m_BW); // transform() keeps it up
    for(int pass = 0; pass < 2; ++pass) {
      const Eigen::LLT<Eigen::MatrixXd> llt(m_space.product(m_W, m_BW));
      const Eigen::MatrixXd R = llt.matrixU();
      if(llt.info() != Eigen::Success ||
         !(R.diagonal().minCoeff() > 1e-7 * R.diagonal().maxCoeff()) ||
         !(R.diagonal().minCoeff() > 1e-12)) {
        reveal_rank();
        return;
      }
      m_space.transform(m_W, m_BW, inverse_of(llt));
      m_link = R * m_link;
    }
  }

  // Gram-Schmidt for a space that is (nearly) invariant along some directions: longest column
  // first, each with its true length, as one Gram matrix does not resolve those below 1e-8 of the
  // longest. The rest is rounding; random vectors without a link replace it.
  void reveal_rank()
  {
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(panel_width, panel_width);
    for(m_rank = 0; m_rank < panel_width; ++m_rank) {
      Eigen::MatrixXd G = gram(), exchange = identity, step = identity, back = identity;
      const Index behind = panel_width - 1 - m_rank;
      Index longest = 0;
      const double length =
          std::sqrt((std::max)(0., G.diagonal().tail(behind + 1).maxCoeff(&longest)));
      if(!(length > rounding * m_norm))
        break;
      exchange.col(m_rank).swap(exchange.col(m_rank + longest));
      G = (exchange * G * exchange).eval();
      step(m_rank, m_rank) = 1. / length;
      step.row(m_rank).tail(behind) = -G.row(m_rank).tail(behind) / (length * length);
      back(m_rank, m_rank) = length;
      back.row(m_rank).tail(behind) = G.row(m_rank).tail(behind) / length;
      m_space.transform(m_W, m_BW, exchange * step);
      m_link = (back * exchange * m_link).eval();
      if(length < 1e-6 * m_norm) {
        orthogonalise();
        if(!(gram()(m_rank, m_rank) > 0.25))
          break; // rounding along the basis
      }
    }
    m_link.bottomRows(panel_width - m_rank).setZero();
    replace_columns();
    m_loss = 1.; // let the next step reorthogonalise
  }

  // Replaces columns beyond the rank. The kept ones come first: were they changed by the others,
  // their link would be another's.
  void replace_columns()
  {
    for(Index i = 0; i < m_space.size(); ++i)
      for(Index c = m_rank; c < panel_width; ++c)
        m_W.row(i)[c] = random_entry() / std::sqrt(m_problem.size());
    for(int pass = 0; pass < 3; ++pass) {
      orthogonalise();
      const Eigen::LLT<Eigen::MatrixXd> llt(gram());
      if(!(llt.matrixLLT().diagonal().minCoeff() > 0.))
        throw Not_converged("the vectors of a block depend on each other");
      m_space.transform(m_W, m_BW, inverse_of(llt));
    }
  }

  // W^T s B W
  Eigen::MatrixXd gram()
  {
    m_space.multiply_mass(m_W, m_BW);
    return m_space.product(m_W, m_BW);
  }

  // Inverts U, where G = U^T U.
  static Eigen::MatrixXd inverse_of(const Eigen::LLT<Eigen::MatrixXd>& llt)
  {
    return llt.matrixU().solve(Eigen::MatrixXd::Identity(panel_width, panel_width));
  }

  static double smallest_singular_value(const Eigen::MatrixXd& R)
  {
    const Eigen::MatrixXd transposed = R.transpose(), product = transposed * R;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(product, Eigen::EigenvaluesOnly);
    return (std::max)(1e-12, std::sqrt((std::max)(0., solver.eigenvalues()(0))));
  }

  double random_entry() { return double(m_random() >> 11) * (2. / 9007199254740992.) - 1.; }

  // --- Ritz pairs ---

  // Whether a group of equal values is so large that a block of eight start vectors may have missed
  // copies. Fewer copies than start vectors are found with probability one; half of that leaves a
  // margin for those that converge late. Values within the tolerance of each other are equal to the
  // iteration: a mixture of their vectors passes as converged.
  bool may_be_incomplete(const Eigen::VectorXd& values) const
  {
    const double width = (std::max)(1e-5, 10. * m_options.tolerance);
    Index group = 1;
    for(Index k = 1; k < m_K; ++k) {
      group = values(k) - values(k - 1) < width * (values(k) + m_problem.shift()) ? group + 1 : 1;
      if(group > panel_width / 2)
        return true;
    }
    return false;
  }

  // Values that are off by more than the width of a gap cannot be counted; their errors go with the
  // square of the tolerance.
  bool is_to_be_counted()
  {
    m_complete = m_options.verify && m_options.tolerance <= 1e-3;
    return m_complete && may_be_incomplete(values());
  }

  // How many eigenvalues below the last one have not been found, -1 where that cannot be told.
  Index missing()
  {
    m_problem.report(0.85);
    const Index count = count_missing(m_problem, values(), m_options.threads);
    m_complete = count == 0;
    return count;
  }

  // Starts again from Ritz vectors and eight more random vectors, until a count of the eigenvalues
  // agrees. Each round finds eight more copies. T has no link to the Ritz vectors. So only
  // converged ones are kept, none beyond the first K, and each step removes what the tolerance
  // leaves of a link.
  void find_missing()
  {
    m_locked = true;
    for(Index round = 0; missing() > 0; ++round) {
      if(round == 4 + m_K / panel_width)
        throw Not_converged("copies of multiple eigenvalues are missing");
      compress(m_K / panel_width * panel_width);
      add_random_panel();
      iterate(m_maximum_panels * panel_width);
    }
  }

  // Extends the space until the K wanted Ritz values have converged. With a shift inside, false if
  // it is next to an eigenvalue, whose vector drowns the others, or if the space is full without
  // all values below the shift: then one of them has more copies than a block finds.
  bool iterate(Index next_check)
  {
    Index last_dimension = 0;
    double last_worst = 1., worst = 1.;
    for(Index restarts = 0;;) {
      step();
      if(m_norm > largest_norm)
        return false;
      m_problem.report(0.85 *
                       (std::min)(1., double(dimension()) / ((m_inside ? 2.4 : 3.4) * m_K + 40.)));
      const bool full = m_panels == m_maximum_panels, invariant = m_rank == 0 && dimension() >= m_K;
      if(full || invariant || dimension() >= next_check) {
        worst = solve_projected();
        if(worst <= m_options.tolerance)
          return true;
        next_check =
            dimension() + distance_to_next_check(worst, last_worst, dimension() - last_dimension);
        last_worst = worst;
        last_dimension = dimension();
      }
      if((full || invariant) && m_inside && worst > 1e-3)
        return false;
      if(!full) {
        advance();
        continue;
      }
      if(++restarts > m_options.maximum_iterations)
        throw Not_converged(
            sentence("a residual of ", worst, " is left after ", restarts - 1, " restarts"));
      restart();
      next_check = last_dimension = 0;
    }
  }

  // Residuals fall geometrically, faster and faster: 0.6 of the way that the last two suggest. A
  // check costs as much as two steps.
  Index distance_to_next_check(double worst, double last_worst, Index distance) const
  {
    const double rate = std::log(last_worst / worst) / double(distance);
    if(!(rate > 0.))
      return 2 * panel_width;
    const double way = 0.6 * std::log(worst / m_options.tolerance) / rate,
                 furthest = (std::max)(6. * panel_width, 0.125 * double(dimension()));
    return rounded_up(static_cast<Index>((std::min)(way, furthest)) + 1);
  }

  // Eigenpairs of T: the wanted ones in the order of their lambda, then those with the largest
  // |theta|. Returns the largest weighted residual of the wanted ones.
  double solve_projected()
  {
    const Index m = dimension();
    const Eigen::MatrixXd T = m_T.topLeftCorner(m, m);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(T);
    if(solver.info() != Eigen::Success)
      throw Not_converged("the projected eigenproblem has no solution");
    const Eigen::VectorXd& theta = solver.eigenvalues(); // ascending
    if(m_below > 0 && !(theta(m_below - 1) < 0.))
      return 1.; // copies of eigenvalues below the shift are missing
    m_theta.resize(m);
    m_Y.resize(m, m);
    Index low = 0, high = m; // taken are those before and from here
    for(Index k = 0; k < m; ++k) {
      const bool negative = k < m_below || (k >= m_K && -theta(low) > theta(high - 1));
      const Index from = k < m_below ? m_below - 1 - k : negative ? low : high - 1;
      m_theta(k) = theta(from);
      m_Y.col(k) = solver.eigenvectors().col(from);
      negative ? ++low : --high;
    }
    const Eigen::MatrixXd link = links(0, m_K);
    double worst = 0.;
    for(Index k = 0; k < m_K; ++k)
      worst = (std::max)(worst, link.col(k).norm() * weight_of_residual(m_theta(k)));
    return worst;
  }

  // Ritz values after the K-th up to the first whose residual shows that it is off by more than a
  // thousandth, which is about the square of the residual.
  Eigen::VectorXd further_values() const
  {
    std::vector<double> result;
    for(Index k = m_K; k < dimension() && Index(result.size()) < m_K / 2; ++k) {
      if(m_theta(k) < 0.) // of no eigenvalue: those below the shift are among the K
        continue;
      if(!(links(k, 1).norm() * weight_of_residual(m_theta(k)) < 0.03))
        break;
      result.push_back(m_sigma + m_problem.shift() / m_theta(k));
    }
    return Eigen::VectorXd::Map(result.data(), Index(result.size()));
  }

  // What S times Ritz vectors has outside of the space: W times this.
  Eigen::MatrixXd links(Index first, Index count) const
  {
    const Eigen::MatrixXd bottom = m_Y.block(dimension() - panel_width, first, panel_width, count);
    return m_link * bottom;
  }

  // 1 / |theta|, times (distance to the shift) / (lambda + scale) where this ratio exceeds 1. So
  // pairs next to 0 are as good as the others where residuals are divided by lambda + scale.
  double weight_of_residual(double theta) const
  {
    const double distance = 1. / std::abs(theta), lambda = m_sigma + m_problem.shift() / theta;
    const double divisor = ((std::max)(0., lambda) + m_problem.scale()) / m_problem.shift();
    return distance * (std::max)(1., distance / divisor);
  }

  // Replaces the basis by its first Ritz vectors.
  void compress(Index kept)
  {
    m_space.rotate(m_basis, m_panels, m_Y.leftCols(kept));
    m_panels = kept / panel_width;
    m_T.setZero();
    m_T.diagonal().head(kept) = m_theta.head(kept);
  }

  // Thick restart (Wu and Simon 2000): S X = X Theta + W E_bottom.
  void restart()
  {
    const Index kept = (std::min)(rounded_up(m_K + 2 * panel_width), dimension() - panel_width);
    const Eigen::MatrixXd arrow = links(0, kept);
    compress(kept);
    m_T.block(kept, 0, panel_width, kept) = arrow;
    m_T.block(0, kept, kept, panel_width) = arrow.transpose();
    push_panel();
    m_after_restart = true;
    m_loss = 1.;
  }

  Eigen::VectorXd lambda() const
  {
    return (m_sigma + m_problem.shift() * m_theta.head(m_K).array().inverse()).matrix();
  }

  // Y and C times (I + C^T C)^-1/2 = I - C^T F C.
  void make_orthonormal(Eigen::MatrixXd& C)
  {
    const Eigen::MatrixXd transposed = C.transpose(), product = C * transposed;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(product);
    const Eigen::ArrayXd root = (1. + solver.eigenvalues().cwiseMax(0.).array()).sqrt();
    const Eigen::VectorXd f = (root * (1. + root)).inverse(); // (1 - 1 / root) / (root^2 - 1)
    const Eigen::MatrixXd Q = solver.eigenvectors(), FC = Q * f.asDiagonal() * Q.transpose() * C;
    m_Y.leftCols(m_K) -= m_Y.leftCols(m_K) * transposed * FC;
    C -= product * FC;
  }

  // Among the wanted eigenvalues: with it the space is smallest.
  static constexpr double place_of_shift = 0.6;
  static constexpr double rounding = 1e-12; // of S
  // That of S where the shift is 1e-4 of a spacing from an eigenvalue.
  static constexpr double largest_norm = 1e4;

  const Eigen_problem& m_problem;
  Index m_K;
  const Eigenpairs_options& m_options;
  bool m_inside;  // the shift is among the wanted eigenvalues
  double m_sigma; // the shift
  double m_factorised = m_sigma;
  Index m_below = 0; // eigenvalues below it
  Supernodal_factor m_factor;
  Panel_space m_space; // with s B in the order of the factor

  Index m_maximum_panels;
  std::vector<Panel> m_basis; // the first m_panels are in use
  Index m_panels = 0;
  Panel m_W, m_BW, m_BV;  // the next panel, its product with s B, that of the last panel
  Eigen::MatrixXd m_link; // R of the next panel
  Eigen::MatrixXd m_T;    // projected operator
  Eigen::VectorXd m_theta;
  Eigen::MatrixXd m_Y; // its eigenpairs, the wanted first
  double m_norm = 1.;  // of S: 1 with the shift below, otherwise as far as T shows it
  double m_loss = 1.;  // estimated loss of orthogonality
  // Columns of the next panel that have a link; 0 where the space is invariant.
  Index m_rank = panel_width;
  bool m_after_restart = false;
  bool m_complete = false;
  bool m_locked = false; // the basis begins with Ritz vectors whose link has been dropped
  std::mt19937_64 m_random;
};

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_BLOCK_LANCZOS_H
