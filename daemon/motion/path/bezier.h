// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

/// Bernstein-Bézier algebra on fixed arrays of coefficients (Farin, Curves and Surfaces for CAGD,
/// 2002, chapters 4-6). `Value` is a scalar or an Eigen vector; parameters lie in [0, 1], so that
/// every step is a convex combination and nothing is amplified.
namespace camway::motion::bezier {

/// The binomial coefficient `n` over `k` for n <= 30; exact in double.
constexpr double binomial(std::size_t n, std::size_t k) {
  double value = 1.0;
  for (std::size_t i = 1; i <= k; ++i)
    value = value * static_cast<double>(n - k + i) / static_cast<double>(i);
  return value;
}

/// Linear interpolation; exactly `a` at 0 and `b` at 1, bit for bit.
template <class Value>
Value lerp(const Value& a, const Value& b, double u) {
  return Value((1.0 - u) * a + u * b);
}

/// One de Casteljau step on the first `count` entries: leaves `count - 1` of them.
template <class Value, std::size_t N>
void step(std::array<Value, N>& c, std::size_t count, double u) {
  for (std::size_t i = 0; i + 1 < count; ++i) c[i] = lerp(c[i], c[i + 1], u);
}

/// The curve's value at `u`.
template <class Value, std::size_t N>
Value value_at(const std::array<Value, N>& c, double u) {
  if constexpr (N == 1) {
    return c[0];
  } else {
    std::array<Value, N - 1> shorter;
    for (std::size_t i = 0; i + 1 < N; ++i) shorter[i] = lerp(c[i], c[i + 1], u);
    return value_at(shorter, u);
  }
}

/// Value and first two derivatives with respect to the parameter.
template <class Value>
struct Jet {
  Value value;
  Value first;
  Value second;
};

/// Value and derivatives from the last three levels of de Casteljau's scheme. Requires degree 2 or
/// more.
template <class Value, std::size_t N>
Jet<Value> jet_at(std::array<Value, N> c, double u) {
  static_assert(N >= 3);
  constexpr double kDegree = static_cast<double>(N - 1);
  for (std::size_t count = N; count > 3; --count) step(c, count, u);
  const Value second = Value(kDegree * (kDegree - 1.0) * ((c[2] - c[1]) - (c[1] - c[0])));
  step(c, 3, u);
  const Value first = Value(kDegree * (c[1] - c[0]));
  return {lerp(c[0], c[1], u), first, second};
}

/// Coefficients of the part over [u0, u1]: the blossom with k arguments u1 and the others u0. The
/// first and the last are `value_at(u0)` and `value_at(u1)` bit for bit, so that parts which share
/// a parameter share the point.
template <class Value, std::size_t N>
std::array<Value, N> sub_curve(std::array<Value, N> c, double u0, double u1) {
  std::array<Value, N> part;
  for (std::size_t k = N; k-- > 0;) {  // c has had N - 1 - k steps at u0 and k + 1 entries left
    std::array<Value, N> d = c;
    for (std::size_t count = k + 1; count > 1; --count) step(d, count, u1);
    part[k] = d[0];
    step(c, k + 1, u0);
  }
  return part;
}

/// Weight of the product of coefficients i and j in coefficient i + j of a product, before division
/// by the binomial of the sum. Integers, so that products of constants come out exact.
template <std::size_t N, std::size_t M>
constexpr std::array<std::array<double, M>, N> product_weights() {
  std::array<std::array<double, M>, N> weights{};
  for (std::size_t i = 0; i < N; ++i)
    for (std::size_t j = 0; j < M; ++j) weights[i][j] = binomial(N - 1, i) * binomial(M - 1, j);
  return weights;
}

/// Coefficients of the product of two polynomials; `multiply(f, g)` multiplies two values and need
/// not commute.
template <class F, class G, std::size_t N, std::size_t M, class Multiply>
auto product(const std::array<F, N>& f, const std::array<G, M>& g, Multiply multiply) {
  using Value = decltype(multiply(f[0], g[0]));
  static constexpr std::array<std::array<double, M>, N> kWeights = product_weights<N, M>();
  static constexpr std::array<std::array<double, N + M - 1>, 1> kSums =
      product_weights<1, N + M - 1>();
  std::array<Value, N + M - 1> result;
  for (std::size_t k = 0; k < N + M - 1; ++k) {
    const std::size_t first = k < M ? 0 : k - (M - 1);
    const std::size_t last = k < N ? k : N - 1;
    Value sum = Value(multiply(f[first], g[k - first]) * kWeights[first][k - first]);
    for (std::size_t i = first + 1; i <= last; ++i)
      sum += multiply(f[i], g[k - i]) * kWeights[i][k - i];
    result[k] = Value(sum / kSums[0][k]);
  }
  return result;
}

/// The same polynomial with coefficients of a degree higher by `Rise`.
template <std::size_t Rise, class Value, std::size_t N>
std::array<Value, N + Rise> elevated(const std::array<Value, N>& c) {
  std::array<double, Rise + 1> one;
  one.fill(1.0);
  return product(c, one, [](const Value& v, double w) { return Value(v * w); });
}

}  // namespace camway::motion::bezier
