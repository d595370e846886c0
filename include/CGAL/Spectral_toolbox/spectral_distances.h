// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_TOOLBOX_SPECTRAL_DISTANCES_H
#define CGAL_SPECTRAL_TOOLBOX_SPECTRAL_DISTANCES_H

#include <CGAL/Spectral_geometry/eigenpairs.h>

#include <initializer_list>

/*!
\file
Distances between the vertices of a mesh and signatures of them, from the eigenpairs of its
Laplacian: the formulas of section 5.1 of Lescoat et al. 2020, truncated to the `K` pairs that are
given.

Common to all functions:
- `pairs` holds `K` eigenpairs of a mesh of `n` vertices, \f$ \phi_i \f$ orthonormal in its mass.
- Sums with \f$ 1/\lambda \f$ or \f$ \log\lambda \f$ skip the zero eigenvalues, one per connected
component
  (`Eigenpairs::zeros`); the others run over all pairs. Distances between different components by
such sums are finite numbers without a meaning.
- The result has a column of `n` values for each source, see `Distance_sources`.
- Units are given for a mesh measured in a unit of length `u`, time `t` of heat in `u^2`. Defaults
of times and energies are multiples of the spectrum's own, so that results do not depend on the
unit. To compare two meshes use *one* set of times or energies for both: take them from one and pass
them to both.
- `std::invalid_argument` is thrown for a source out of range, and for a time or energy that is not
finite, or negative where it must not be. Where a nonzero eigenvalue is needed, it is also thrown if
all of them are zero, if `zeros` is not known, or if an eigenvalue after the first `zeros` was
computed as zero.
*/

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationEvaluation
/// @{

/*!
the places to measure distances from: a vertex, several of them, or points anywhere on the surface.

A point is a row of an interpolation W, as `closest_point_interpolation()` makes it: the
eigenfunctions there are \f$ W \phi_i \f$. On a simplified mesh take the points closest to the
input's vertices: the coarse vertices of the vertex map lie up to an edge away.
*/
class Distance_sources
{
public:
  /// the vertex `source`: an integer, or what converts to one such as `Surface_mesh::Vertex_index`.
  template <class Vertex,
            class = std::enable_if_t<std::is_convertible<const Vertex&, Eigen::Index>::value>>
  Distance_sources(const Vertex& source)
    : m_vertices{static_cast<Eigen::Index>(source)}
  {}
  /// the given vertices.
  Distance_sources(std::vector<Eigen::Index> sources)
    : m_vertices(std::move(sources))
  {}
  /// the given vertices.
  Distance_sources(std::initializer_list<Eigen::Index> sources)
    : m_vertices(sources)
  {}
  /// a point for each row of `W`, (number of sources) x n, whose entries sum to 1.
  template <class Interpolation>
  Distance_sources(const Eigen::SparseMatrixBase<Interpolation>& W)
    : m_points(W)
    , m_are_points(true)
  {}

  /// whether they were given as vertices.
  bool are_vertices() const { return !m_are_points; }

  /// the number of sources.
  Eigen::Index size() const
  {
    return m_are_points ? m_points.rows() : static_cast<Eigen::Index>(m_vertices.size());
  }

  /// returns the values at the sources of `functions`, which have a row for each vertex. Throws
  /// `std::invalid_argument` for a vertex out of range, an interpolation of another mesh, and a row
  /// of it that does not sum to 1 within 1e-6.
  Eigen::MatrixXd values(const Eigen::Ref<const Eigen::MatrixXd>& functions) const
  {
    const Eigen::Index n = functions.rows();
    if(m_are_points) {
      internal::require(m_points.cols() == n,
                        "spectral distances: the sources are points of a mesh of ", m_points.cols(),
                        " vertices, but there are ", n, ", pass an interpolation on this mesh.");
      const Eigen::VectorXd sums = m_points * Eigen::VectorXd::Ones(n);
      for(Eigen::Index s = 0; s < size(); ++s)
        internal::require(std::abs(sums(s) - 1) <= 1e-6,
                          "spectral distances: the weights of source ", s, " sum to ", sums(s),
                          ", pass an interpolation, whose rows sum to 1.");
      return m_points * functions;
    }
    Eigen::MatrixXd result(size(), functions.cols());
    for(Eigen::Index s = 0; s < size(); ++s) {
      const Eigen::Index v = m_vertices[s];
      internal::require(v >= 0 && v < n, "spectral distances: source ", v, " is not one of the ", n,
                        " vertices, pass an index in [0, n).");
      result.row(s) = functions.row(v);
    }
    return result;
  }

private:
  std::vector<Eigen::Index> m_vertices;
  Eigen::SparseMatrix<double> m_points;
  bool m_are_points = false;
};

namespace internal {

inline void check_time(double t)
{
  require(t >= 0 && std::isfinite(t), "spectral distances: the time ", t,
          " is negative or not finite, pass a time of heat of at least 0.");
}

inline void check_steps(Eigen::Index steps, Eigen::Index least)
{
  require(steps >= least, "spectral distances: ", steps, " steps are asked for, take at least ",
          least, ".");
}

// The eigenvalues without those of the kernel.
inline Eigen::ArrayXd nonzero_values(const Eigenpairs& pairs)
{
  require(pairs.zeros >= 0,
          "spectral distances: the eigenpairs do not say how many eigenvalues are zero; "
          "set Eigenpairs::zeros to the number of connected components.");
  const Eigen::Index first = pairs.zeros;
  require(first < pairs.size(), "spectral distances: all of the ", pairs.size(),
          " eigenvalues are zero, compute more of them than the mesh has components.");
  require(pairs.values(first) > 0, "spectral distances: eigenvalue ", first,
          " was computed as zero, but only ", first,
          " are; the component has a neck that is too narrow for doubles.");
  return pairs.values.tail(pairs.size() - first).array();
}

// Squared distances in the embedding v -> (sqrt(w_i) phi_i(v)) by the last pairs, as many as there
// are weights. Differences first: the expansion of the square would lose the distances of close
// vertices.
inline Eigen::MatrixXd squared_distances(const Eigenpairs& pairs, const Distance_sources& sources,
                                         const Eigen::ArrayXd& weights)
{
  const auto functions = pairs.vectors.rightCols(weights.size());
  const Eigen::VectorXd scales = weights.sqrt().matrix();
  const Eigen::MatrixXd at_sources = scales.asDiagonal() * sources.values(functions).transpose();
  const Eigen::MatrixXd embedding = scales.asDiagonal() * functions.transpose();
  Eigen::MatrixXd distances(embedding.cols(), sources.size());
  for(Eigen::Index s = 0; s < sources.size(); ++s)
    distances.col(s) =
        (embedding.colwise() - at_sources.col(s)).colwise().squaredNorm().transpose();
  return distances;
}

} // namespace internal

/// returns a time for `squared_diffusion_distance()` and `heat_kernel()`: \f$ 1/(4\lambda) \f$ with
/// the first nonzero eigenvalue, in u^2. On a sphere of unit area it is 0.00995; Lescoat et al.
/// show 0.01.
inline double default_diffusion_time(const Eigenpairs& pairs)
{
  return 1 / (4 * internal::nonzero_values(pairs)(0));
}

/*!
returns the **squared** diffusion distances \f$ \sum_i (\phi_i(u) - \phi_i(v))^2 e^{-2 \lambda_i t}
\f$, in u^-2 (Coifman and Lafon 2006). Lescoat et al. 2020 write this sum without a root.

@param pairs all of them are used, the zeros included
@param sources `u`, one column of the result each
@param t time of heat in u^2, at least 0, see `default_diffusion_time()`
@return n x (number of sources)
*/
inline Eigen::MatrixXd squared_diffusion_distance(const Eigenpairs& pairs,
                                                  const Distance_sources& sources, double t)
{
  internal::check_time(t);
  return internal::squared_distances(pairs, sources, (-2 * t * pairs.values.array()).exp());
}

/*!
returns the **squared** biharmonic distances \f$ \sum_i (\phi_i(u) - \phi_i(v))^2 / \lambda_i^2 \f$,
in u^2 (Lipman, Rustamov and Funkhouser 2010). Zeros are skipped. The terms fall so fast that few
pairs are enough: between antipodes of the unit sphere the sum is pi/12, of which 100 pairs
give 99.5 %.

@param pairs at least one with a nonzero eigenvalue
@param sources `u`, one column of the result each
@return n x (number of sources)
*/
inline Eigen::MatrixXd squared_biharmonic_distance(const Eigenpairs& pairs,
                                                   const Distance_sources& sources)
{
  return internal::squared_distances(pairs, sources,
                                     internal::nonzero_values(pairs).square().inverse());
}

/*!
returns the **squared** commute-time distances \f$ \sum_i (\phi_i(u) - \phi_i(v))^2 / \lambda_i \f$,
without unit (Qiu and Hancock 2007). Zeros are skipped. With all `n` pairs it is the effective
resistance of the network of cotangent weights, whatever the mass; the commute time of a random walk
is that times the volume of the network. On surfaces the sum grows with the logarithm of `K`:
compare at one `K`.

@param pairs at least one with a nonzero eigenvalue
@param sources `u`, one column of the result each
@return n x (number of sources)
*/
inline Eigen::MatrixXd squared_commute_time_distance(const Eigenpairs& pairs,
                                                     const Distance_sources& sources)
{
  return internal::squared_distances(pairs, sources, internal::nonzero_values(pairs).inverse());
}

/*!
returns the heat kernel \f$ \sum_i \phi_i(u) \phi_i(v) e^{-\lambda_i t} \f$, in u^-2.

@param pairs all of them are used, the zeros included
@param sources `u`, one column of the result each
@param t time of heat in u^2, at least 0
@return n x (number of sources)
*/
inline Eigen::MatrixXd heat_kernel(const Eigenpairs& pairs, const Distance_sources& sources,
                                   double t)
{
  internal::check_time(t);
  const Eigen::VectorXd decay = (-t * pairs.values.array()).exp();
  return pairs.vectors * (sources.values(pairs.vectors) * decay.asDiagonal()).transpose();
}

/*!
returns times for `heat_kernel_signature()`: `steps` of them with constant ratio, from
\f$ 4 \ln 10 / \lambda_K \f$ to \f$ 4 \ln 10 / \lambda_1 \f$, in u^2, where \f$ \lambda_1 \f$ is the
first nonzero eigenvalue and \f$ \lambda_K \f$ the last (Sun, Ovsjanikov and Guibas 2009). At these
times the last and the first mode have decayed to 1e-4.

@param pairs at least one with a nonzero eigenvalue
@param steps at least 1; with 1 only the first time is returned
*/
inline Eigen::VectorXd heat_kernel_times(const Eigenpairs& pairs, Eigen::Index steps = 100)
{
  internal::check_steps(steps, 1);
  const double first = internal::nonzero_values(pairs)(0), last = pairs.values(pairs.size() - 1);
  const double scale = 4 * std::log(10.);
  Eigen::VectorXd times(steps);
  for(Eigen::Index i = 0; i < steps; ++i) {
    const double s = steps > 1 ? static_cast<double>(i) / static_cast<double>(steps - 1) : 0.;
    times(i) = scale / last * std::pow(last / first, s);
  }
  return times;
}

/*!
returns the heat kernel signature \f$ HKS(v, t) = \sum_i \phi_i^2(v) e^{-\lambda_i t} \f$ (Sun,
Ovsjanikov and Guibas 2009), in u^-2, not normalised.

@param pairs all of them are used, the zeros included
@param times in u^2, at least 0, see `heat_kernel_times()`
@return n x (number of times)
*/
inline Eigen::MatrixXd heat_kernel_signature(const Eigenpairs& pairs, const Eigen::VectorXd& times)
{
  for(const double t : times)
    internal::check_time(t);
  const Eigen::MatrixXd decay = (-pairs.values * times.transpose()).array().exp();
  return pairs.vectors.cwiseAbs2() * decay;
}

/// the heat kernel signature at `heat_kernel_times()`, n x 100.
inline Eigen::MatrixXd heat_kernel_signature(const Eigenpairs& pairs)
{
  return heat_kernel_signature(pairs, heat_kernel_times(pairs));
}

/// the energies (logarithms of eigenvalues) at which the wave kernel signature is taken: `steps` of
/// them at equal distances from `t_min` to `t_max`, each seen through a Gaussian of standard
/// deviation `sigma`.
struct Wave_kernel_energies
{
  double t_min;       ///< the first energy
  double t_max;       ///< the last energy, not smaller
  double sigma;       ///< positive
  Eigen::Index steps; ///< at least 1, 2 for a distance

  /// the energy of the step `i`.
  double at(Eigen::Index i) const
  {
    return steps > 1
               ? t_min + (t_max - t_min) * static_cast<double>(i) / static_cast<double>(steps - 1)
               : t_min;
  }
};

/*!
returns energies for `wave_kernel_signature()` and `wave_kernel_distance()` as Aubry, Schlickewei
and Cremers 2011: \f$ \sigma = 0.07 (\log\lambda_K - \log\lambda_1) \f$ (seven of their hundred
steps), \f$ t_{min} = \log\lambda_1 + 2 \sigma, t_{max} = \log\lambda_K - 2 \sigma \f$, with the
first nonzero eigenvalue \f$ \lambda_1 \f$ and the last \f$ \lambda_K \f$. Another unit of length
moves all energies by one constant.

@param pairs at least two with different nonzero eigenvalues
@param steps at least 1, 2 for a distance. More steps refine the sampling and change neither sigma
nor the interval.

Throws `std::invalid_argument` if all nonzero eigenvalues are equal: then choose the energies by
hand.
*/
inline Wave_kernel_energies wave_kernel_energies(const Eigenpairs& pairs, Eigen::Index steps = 100)
{
  internal::check_steps(steps, 1);
  const double first = std::log(internal::nonzero_values(pairs)(0));
  const double last = std::log(pairs.values(pairs.size() - 1));
  const double sigma = 0.07 * (last - first);
  internal::require(last - first > 1e-9, // equal ones differ by rounding
                    "spectral distances: all nonzero eigenvalues are equal, the wave kernel has "
                    "no range of energies, compute more eigenpairs.");
  return {first + 2 * sigma, last - 2 * sigma, sigma, steps};
}

/*!
returns the wave kernel signature (Aubry, Schlickewei and Cremers 2011), in u^-2,
\f[ WKS(v, t) = \sum_i \phi_i^2(v) e^{-(t - \log\lambda_i)^2 / 2\sigma^2}
                 / \sum_i e^{-(t - \log\lambda_i)^2 / 2\sigma^2}. \f]
Zeros are skipped. Exponents are taken relative to the largest, so that energies far from the
spectrum give the signature of the nearest eigenvalue and not 0/0.

@param pairs at least one with a nonzero eigenvalue
@param energies see `wave_kernel_energies()`
@return n x `energies.steps`
*/
inline Eigen::MatrixXd wave_kernel_signature(const Eigenpairs& pairs,
                                             const Wave_kernel_energies& energies)
{
  internal::check_steps(energies.steps, 1);
  internal::require(energies.sigma > 0 && std::isfinite(energies.sigma) &&
                        energies.t_min <= energies.t_max && std::isfinite(energies.t_min) &&
                        std::isfinite(energies.t_max),
                    "spectral distances: the energies of the wave kernel are [", energies.t_min,
                    ", ", energies.t_max, "] with sigma ", energies.sigma,
                    ", pass a finite ascending interval and a positive sigma.");
  const Eigen::ArrayXd log_values = internal::nonzero_values(pairs).log();
  const Eigen::Index modes = log_values.size();
  Eigen::MatrixXd weights(modes, energies.steps);
  for(Eigen::Index i = 0; i < energies.steps; ++i) {
    const Eigen::ArrayXd exponents = -((energies.at(i) - log_values) / energies.sigma).square() / 2;
    const Eigen::ArrayXd gaussians = (exponents - exponents.maxCoeff()).exp();
    weights.col(i) = (gaussians / gaussians.sum()).matrix();
  }
  return pairs.vectors.rightCols(modes).cwiseAbs2() * weights;
}

/// the wave kernel signature at `wave_kernel_energies()`, n x 100.
inline Eigen::MatrixXd wave_kernel_signature(const Eigenpairs& pairs)
{
  return wave_kernel_signature(pairs, wave_kernel_energies(pairs));
}

/*!
returns the wave kernel distances
\f[ \int_{t_{min}}^{t_{max}} \left| \frac{WKS(u,t) - WKS(v,t)}{WKS(u,t) + WKS(v,t)} \right| dt, \f]
without unit, not squared, by the trapezoidal rule on the steps of the energies. Between 0 and
\f$ t_{max} - t_{min} \f$. It compares signatures: vertices that a symmetry of the shape exchanges
have distance 0. Energies at which both signatures vanish count as equal.

@param pairs, energies as for `wave_kernel_signature()`, with at least 2 steps
@param sources `u`, one column of the result each
@return n x (number of sources)
*/
inline Eigen::MatrixXd wave_kernel_distance(const Eigenpairs& pairs,
                                            const Distance_sources& sources,
                                            const Wave_kernel_energies& energies)
{
  internal::check_steps(energies.steps, 2);
  Eigenpairs at_sources;
  at_sources.values = pairs.values;
  at_sources.vectors = sources.values(pairs.vectors);
  at_sources.zeros = pairs.zeros;
  const Eigen::MatrixXd signature = wave_kernel_signature(pairs, energies);
  // At a point eigenfunctions are interpolated, then squared; a vertex has its own numbers, to the
  // last bit.
  const Eigen::MatrixXd of_sources = sources.are_vertices()
                                         ? sources.values(signature)
                                         : wave_kernel_signature(at_sources, energies);
  const double step = (energies.t_max - energies.t_min) / static_cast<double>(energies.steps - 1);
  Eigen::MatrixXd distances = Eigen::MatrixXd::Zero(signature.rows(), sources.size());
  for(Eigen::Index s = 0; s < sources.size(); ++s)
    for(Eigen::Index i = 0; i < energies.steps; ++i) {
      const Eigen::ArrayXd sum = signature.col(i).array() + of_sources(s, i);
      const Eigen::ArrayXd ratio =
          (sum > 0).select((signature.col(i).array() - of_sources(s, i)).abs() / sum, 0.);
      const double weight = (i == 0 || i == energies.steps - 1) ? step / 2 : step;
      distances.col(s) += weight * ratio.matrix();
    }
  return distances;
}

/// @}

} // namespace CGAL::Spectral_geometry

#endif // CGAL_SPECTRAL_TOOLBOX_SPECTRAL_DISTANCES_H
