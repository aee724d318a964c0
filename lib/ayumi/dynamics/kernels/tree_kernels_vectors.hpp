// Part of tree_kernels_body.hpp: vectors and turns of scalars T, sines and cosines, and joints.

// The function is declared here, because its header has inline functions, which would be compiled
// here for a processor that the user may not have.
namespace ayumi::elementary {
double sin(double x);
double cos(double x);
}  // namespace ayumi::elementary

namespace {

using ayumi::kernels::Job;
using ayumi::kernels::Link;
using ayumi::kernels::Tree;

template <typename T>
inline T load(const double* from, int k) {
  T value;
  __builtin_memcpy(&value, from + k * static_cast<int>(sizeof(T) / sizeof(double)), sizeof(T));
  return value;
}
template <typename T>
inline void store(double* to, int k, T value) {
  __builtin_memcpy(to + k * static_cast<int>(sizeof(T) / sizeof(double)), &value, sizeof(T));
}

template <typename T>
struct Vec {
  T x[3];
  T& operator[](int i) { return x[i]; }
  const T& operator[](int i) const { return x[i]; }
};

template <typename T>
inline Vec<T> operator+(const Vec<T>& a, const Vec<T>& b) {
  return {{a[0] + b[0], a[1] + b[1], a[2] + b[2]}};
}
template <typename T>
inline void add_to(Vec<T>& a, const Vec<T>& b) {
  a[0] += b[0], a[1] += b[1], a[2] += b[2];
}
template <typename A, typename B>
inline auto dot(const A& a, const B& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <typename T, typename A, typename B>
inline Vec<T> cross(const A& a, const B& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}
// Matrices of nine numbers, row by row.
template <typename T, typename A, typename B>
inline Vec<T> times(const A& m, const B& v) {
  return {{m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[3] * v[0] + m[4] * v[1] + m[5] * v[2],
           m[6] * v[0] + m[7] * v[1] + m[8] * v[2]}};
}
template <typename T, typename A, typename B>
inline Vec<T> transposed_times(const A& m, const B& v) {
  return {{m[0] * v[0] + m[3] * v[1] + m[6] * v[2], m[1] * v[0] + m[4] * v[1] + m[7] * v[2],
           m[2] * v[0] + m[5] * v[1] + m[8] * v[2]}};
}
// Symmetric matrices of six numbers.
template <typename T, typename A, typename B>
inline Vec<T> symmetric_times(const A& m, const B& v) {
  return {{m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[1] * v[0] + m[3] * v[1] + m[4] * v[2],
           m[2] * v[0] + m[4] * v[1] + m[5] * v[2]}};
}
constexpr int kSix[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};

// The turn of a joint about axis K: it takes the parent's components to the link's, and back.
template <int K, typename T>
inline Vec<T> into(const Vec<T>& v, T c, T s) {
  constexpr int a = (K + 1) % 3, b = (K + 2) % 3;
  Vec<T> result;
  result[K] = v[K];
  result[a] = c * v[a] + s * v[b];
  result[b] = c * v[b] - s * v[a];
  return result;
}
template <int K, typename T>
inline Vec<T> back(const Vec<T>& v, T c, T s) {
  constexpr int a = (K + 1) % 3, b = (K + 2) % 3;
  Vec<T> result;
  result[K] = v[K];
  result[a] = c * v[a] - s * v[b];
  result[b] = s * v[a] + c * v[b];
  return result;
}

// sin and cos by Taylor's series on |r| <= pi/4, where r is the angle minus the nearest multiple of
// pi/2. That multiple is subtracted in three parts, of which the first two multiply exactly. The
// result is within 2 units of the last place up to |q| = 1e5.
constexpr double kLargestAngle = 1e5;
template <typename T>
inline void sine_cosine(T q, T& sine, T& cosine) {
  // The number is 1.5 * 2^52. The last bit of a sum with it has the value 1.
  constexpr double kRound = 6755399441055744.0;
  const T shifted = q * 0.63661977236758134308 + kRound;
  const T k = shifted - kRound;
  T r = q - k * 0x1.921fb544p0;
  r = r - k * 0x1.0b4611a6p-34;
  r = r - k * 0x1.3198a2e037073p-69;
  const T x = r * r;
  T s = x * (-1.0 / 1307674368000.0) + 1.0 / 6227020800.0;
  s = s * x - 1.0 / 39916800.0;
  s = s * x + 1.0 / 362880.0;
  s = s * x - 1.0 / 5040.0;
  s = s * x + 1.0 / 120.0;
  s = s * x - 1.0 / 6.0;
  s = r + r * (x * s);
  T c = x * (1.0 / 20922789888000.0) - 1.0 / 87178291200.0;
  c = c * x + 1.0 / 479001600.0;
  c = c * x - 1.0 / 3628800.0;
  c = c * x + 1.0 / 40320.0;
  c = c * x - 1.0 / 720.0;
  c = c * x + 1.0 / 24.0;
  c = 1.0 - x * (0.5 - x * c);
  // With k mod 4 as m = 0, 1, +-2, -1, the sine is s, c, -s, -c and the cosine c, -s, -c, s.
  const T half = k * 0.5;
  const T rest = half - ((half + kRound) - kRound);  // 0 or +-0.5
  const T odd = rest * rest * 4.0;
  const T m = k - 4.0 * ((k * 0.25 + kRound) - kRound);
  const T even = (1.0 - odd) * (1.0 - 0.5 * (m * m));  // 0, 1 or -1
  const T turn = odd * m;                              // 0, 1 or -1
  sine = even * s + turn * c;
  cosine = even * c - turn * s;
}

// The coordinate of a joint with its sine and cosine.
template <typename T>
struct Joint {
  T q, s, c;
};

template <typename T>
inline bool any_large(T q) {
  for (unsigned i = 0; i < sizeof(T) / sizeof(double); ++i)
    if (!(__builtin_fabs(load<double>(reinterpret_cast<const double*>(&q), static_cast<int>(i))) <
          kLargestAngle))
      return true;
  return false;
}

// Angles beyond the range of the series are computed by math/elementary, one by one.
template <typename T>
__attribute__((noinline)) void far_sine_cosine(T q, T& s, T& c) {
  for (unsigned i = 0; i < sizeof(T) / sizeof(double); ++i) {
    double angle;
    __builtin_memcpy(&angle, reinterpret_cast<const char*>(&q) + i * sizeof(double), sizeof angle);
    const double sine = ayumi::elementary::sin(angle), cosine = ayumi::elementary::cos(angle);
    __builtin_memcpy(reinterpret_cast<char*>(&s) + i * sizeof(double), &sine, sizeof sine);
    __builtin_memcpy(reinterpret_cast<char*>(&c) + i * sizeof(double), &cosine, sizeof cosine);
  }
}

inline void sines_and_cosines(const double* angle, double* sine, double* cosine, int count) {
  constexpr int kLanes = static_cast<int>(sizeof(Wide) / sizeof(double));
  for (int first = 0; first < count; first += kLanes) {
    const int left = count - first < kLanes ? count - first : kLanes;
    Wide q{}, s, c;
#pragma GCC unroll 4
    for (int k = 0; k < kLanes; ++k) q[k] = angle[first + (k < left ? k : 0)];
    if (__builtin_expect(any_large(q), 0))
      far_sine_cosine(q, s, c);
    else
      sine_cosine(q, s, c);
#pragma GCC unroll 4
    for (int k = 0; k < kLanes; ++k) {
      if (k == left) break;
      sine[first + k] = s[k];
      cosine[first + k] = c[k];
    }
  }
}

// Several joints of one state, or one joint of several states, go through the series at once. These
// functions write and read the place of one joint in such a group: one lane for one state, or all
// lanes for several states. They do not go through memory, because a vector that was just stored
// number by number is loaded slowly.
inline void put_lane(Wide& all, int lane, double x) { all[lane] = x; }
inline void put_lane(Wide& all, int, const Wide& x) { all = x; }
inline void get_lane(const Wide& all, int lane, double& x) { x = all[lane]; }
inline void get_lane(const Wide& all, int, Wide& x) { x = all; }

template <typename T>
inline void find_joints(const Tree& tree, const Job& job, Joint<T>* joints) {
  constexpr int kLanes = static_cast<int>(sizeof(Wide) / sizeof(T));
  for (int i = 1; i < tree.count; ++i) {
    const Link& link = tree.links[i];
    joints[i].q = link.ratio * load<T>(job.theta, link.dof) + link.offset;
  }
  for (int first = 1; first < tree.count; first += kLanes) {
    const int last = tree.count - 1;
    bool large = false;
    Wide all{}, sines, cosines;
#pragma GCC unroll 4
    for (int k = 0; k < kLanes; ++k) {
      const T angle = joints[first + k <= last ? first + k : last].q;
      put_lane(all, k, angle);
      large |= any_large(angle);
    }
    if (__builtin_expect(large, 0))
      far_sine_cosine(all, sines, cosines);
    else
      sine_cosine(all, sines, cosines);
#pragma GCC unroll 4
    for (int k = 0; k < kLanes; ++k) {
      if (first + k > last) break;
      get_lane(sines, k, joints[first + k].s);
      get_lane(cosines, k, joints[first + k].c);
    }
  }
}

template <typename T>
struct Attitude {
  T R[9];
  explicit Attitude(const double* quaternion) {
    const T x = load<T>(quaternion, 0), y = load<T>(quaternion, 1), z = load<T>(quaternion, 2),
            w = load<T>(quaternion, 3);
    const T x2 = x + x, y2 = y + y, z2 = z + z;
    R[0] = 1.0 - (y * y2 + z * z2);
    R[1] = x * y2 - w * z2;
    R[2] = x * z2 + w * y2;
    R[3] = x * y2 + w * z2;
    R[4] = 1.0 - (x * x2 + z * z2);
    R[5] = y * z2 - w * x2;
    R[6] = x * z2 - w * y2;
    R[7] = y * z2 + w * x2;
    R[8] = 1.0 - (x * x2 + y * y2);
  }
};

template <typename T>
inline Vec<T> load_vec(const double* from, int k) {
  return {{load<T>(from, k), load<T>(from, k + 1), load<T>(from, k + 2)}};
}

// The origin of the joint in the parent.
template <typename T>
inline Vec<T> arm_of(const Link& link, T q) {
  Vec<T> r;
  for (int k = 0; k < 3; ++k) {
    if (link.prismatic)
      r[k] = link.r[k] + link.E[3 * k + link.axis] * q;
    else
      r[k] = T{} + link.r[k];
  }
  return r;
}

// A symmetric matrix, turned back by the joint about K.
template <int K, typename T>
inline void turn_symmetric(T* S, T c, T s) {
  constexpr int a = (K + 1) % 3, b = (K + 2) % 3;
  T &kk_a = S[kSix[K][a]], &kk_b = S[kSix[K][b]];
  const T ka = kk_a, kb = kk_b;
  kk_a = c * ka - s * kb;
  kk_b = s * ka + c * kb;
  T &aa = S[kSix[a][a]], &bb = S[kSix[b][b]], &ab = S[kSix[a][b]];
  // The rows are turned first, (a, b) -> (c a - s b, s a + c b), and then the columns in the same
  // way.
  const T raa = c * aa - s * ab, rab = c * ab - s * bb, rbb = s * ab + c * bb;
  const T rba = s * aa + c * ab;
  aa = c * raa - s * rab;
  ab = s * raa + c * rab;
  bb = s * rba + c * rbb;
}
template <int K, typename T>
inline void turn_general(T* H, T c, T s) {
  constexpr int a = (K + 1) % 3, b = (K + 2) % 3;
  for (int j = 0; j < 3; ++j) {
    const T x = H[3 * a + j], y = H[3 * b + j];
    H[3 * a + j] = c * x - s * y;
    H[3 * b + j] = s * x + c * y;
  }
  for (int i = 0; i < 3; ++i) {
    const T x = H[3 * i + a], y = H[3 * i + b];
    H[3 * i + a] = c * x - s * y;
    H[3 * i + b] = s * x + c * y;
  }
}
template <typename T>
inline void turn_by(const double* E, T* H) {
  T X[9];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      X[3 * i + j] = E[3 * i] * H[j] + E[3 * i + 1] * H[3 + j] + E[3 * i + 2] * H[6 + j];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      H[3 * i + j] =
          X[3 * i] * E[3 * j] + X[3 * i + 1] * E[3 * j + 1] + X[3 * i + 2] * E[3 * j + 2];
}
template <typename T>
inline void turn_symmetric_by(const double* E, T* S) {
  T X[9] = {S[0], S[1], S[2], S[1], S[3], S[4], S[2], S[4], S[5]};
  turn_by(E, X);
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) S[kSix[i][j]] = X[3 * i + j];
}

}  // namespace
