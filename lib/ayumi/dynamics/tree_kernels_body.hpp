// Inverse and forward dynamics in link axes about the link's origin, for a scalar T that holds one
// or several states; included by one source per instruction set, which names Wide. No guard, no
// external names. With E the joint frame's turn, P the joint's and r its origin in the parent,
// classical accelerations a (of the origin, gravity added) and W = [alpha x] + w w' - |w|^2:
//   outwards:  w = (E P)' w_p + s dq,   alpha = (E P)' alpha_p + s ddq + w x s dq,
//              a = (E P)' (a_p + W_p r)                    (sliding: r + s q, + s ddq + 2 w x s dq)
//   of a body: f = m a + W h,   n = h x a + I alpha + w x I w
//   inwards:   tau = s.n (sliding s.f),  f_p += E P f,  n_p += E P n + r x (E P f)
// Forward: the articulated f = M a + H alpha + p_f, n = H' a + I alpha + p_n go inwards with the
// joint solved out, U = (H s, I s), D = s.I s + rotor:  (M H; H' I) -= U U' / D.

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
// Matrices of nine, row by row.
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
// Symmetric matrices of six.
template <typename T, typename A, typename B>
inline Vec<T> symmetric_times(const A& m, const B& v) {
  return {{m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[1] * v[0] + m[3] * v[1] + m[4] * v[2],
           m[2] * v[0] + m[4] * v[1] + m[5] * v[2]}};
}
constexpr int kSix[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};

// The turn of a joint about axis K: parent's components into the link's, and back.
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

// sin and cos by Taylor's series on |r| <= pi/4, the nearest multiple of pi/2 taken off in three
// parts of which the first two multiply exactly. Within 2 units of the last place to |q| = 1e5.
constexpr double kLargestAngle = 1e5;
template <typename T>
inline void sine_cosine(T q, T& sine, T& cosine) {
  constexpr double kRound = 6755399441055744.0;  // 1.5 * 2^52: the sum's last bit is worth one
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
  // k mod 4 as m = 0, 1, +-2, -1: the sine is s, c, -s, -c, the cosine c, -s, -c, s.
  const T half = k * 0.5;
  const T rest = half - ((half + kRound) - kRound);  // 0 or +-0.5
  const T odd = rest * rest * 4.0;
  const T m = k - 4.0 * ((k * 0.25 + kRound) - kRound);
  const T even = (1.0 - odd) * (1.0 - 0.5 * (m * m));  // 0, 1 or -1
  const T turn = odd * m;                              // 0, 1 or -1
  sine = even * s + turn * c;
  cosine = even * c - turn * s;
}

// Joint positions of all links, and sines and cosines of those that turn.
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

// Angles beyond the series' reach go to the library, one by one.
template <typename T>
__attribute__((noinline)) void far_sine_cosine(T q, T& s, T& c) {
  for (unsigned i = 0; i < sizeof(T) / sizeof(double); ++i) {
    double angle;
    __builtin_memcpy(&angle, reinterpret_cast<const char*>(&q) + i * sizeof(double), sizeof angle);
    const double sine = __builtin_sin(angle), cosine = __builtin_cos(angle);
    __builtin_memcpy(reinterpret_cast<char*>(&s) + i * sizeof(double), &sine, sizeof sine);
    __builtin_memcpy(reinterpret_cast<char*>(&c) + i * sizeof(double), &cosine, sizeof cosine);
  }
}

inline void sines_and_cosines(const double* angle, double* sine, double* cosine, int count) {
  constexpr int kLanes = static_cast<int>(sizeof(Wide) / sizeof(double));
  for (int first = 0; first < count; first += kLanes) {
    const int left = count - first < kLanes ? count - first : kLanes;
    Wide q{}, s, c;
    __builtin_memcpy(&q, angle + first, sizeof(double) * static_cast<unsigned long>(left));
    if (__builtin_expect(any_large(q), 0))
      far_sine_cosine(q, s, c);
    else
      sine_cosine(q, s, c);
    __builtin_memcpy(sine + first, &s, sizeof(double) * static_cast<unsigned long>(left));
    __builtin_memcpy(cosine + first, &c, sizeof(double) * static_cast<unsigned long>(left));
  }
}

template <typename T>
inline void find_joints(const Tree& tree, const Job& job, Joint<T>* joints) {
  // Several joints of one state, or one joint of several states, go through the series at once.
  constexpr int kLanes = static_cast<int>(sizeof(Wide) / sizeof(T));
  for (int first = 1; first < tree.count; first += kLanes) {
    alignas(64) T angle[kLanes] = {}, s[kLanes], c[kLanes];
    const int count = first + kLanes <= tree.count ? kLanes : tree.count - first;
    bool large = false;
    for (int k = 0; k < count; ++k) {
      const Link& link = tree.links[first + k];
      angle[k] = link.ratio * load<T>(job.theta, link.dof) + link.offset;
      large = large || any_large(angle[k]);
    }
    Wide all, sines, cosines;
    __builtin_memcpy(&all, angle, sizeof all);
    if (__builtin_expect(large, 0))
      far_sine_cosine(all, sines, cosines);
    else
      sine_cosine(all, sines, cosines);
    __builtin_memcpy(s, &sines, sizeof s);
    __builtin_memcpy(c, &cosines, sizeof c);
    for (int k = 0; k < count; ++k) joints[first + k] = {angle[k], s[k], c[k]};
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

// Joint origin in the parent.
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

template <typename T>
struct Moving {
  Vec<T> w, alpha, a, f, n;
  T W[9];
};

template <int K, typename T>
inline void turn_joint(Moving<T>& t, const Joint<T>& joint, T rate, T acceleration) {
  constexpr int a = (K + 1) % 3, b = (K + 2) % 3;
  t.w = into<K>(t.w, joint.c, joint.s);
  t.alpha = into<K>(t.alpha, joint.c, joint.s);
  t.a = into<K>(t.a, joint.c, joint.s);
  t.alpha[a] += t.w[b] * rate;
  t.alpha[b] -= t.w[a] * rate;
  t.alpha[K] += acceleration;
  t.w[K] += rate;
}

template <typename T>
inline void weigh(const Link& link, Moving<T>& t) {
  const T x = t.w[0], y = t.w[1], z = t.w[2];
  const T xx = x * x, yy = y * y, zz = z * z, xy = x * y, xz = x * z, yz = y * z;
  t.W[0] = -(yy + zz);
  t.W[1] = xy - t.alpha[2];
  t.W[2] = xz + t.alpha[1];
  t.W[3] = xy + t.alpha[2];
  t.W[4] = -(xx + zz);
  t.W[5] = yz - t.alpha[0];
  t.W[6] = xz - t.alpha[1];
  t.W[7] = yz + t.alpha[0];
  t.W[8] = -(xx + yy);
  const Vec<T> Wh = times<T>(t.W, link.moment);
  for (int k = 0; k < 3; ++k) t.f[k] = link.mass * t.a[k] + Wh[k];
  t.n = symmetric_times<T>(link.I, t.alpha) + cross<T>(link.moment, t.a) +
        cross<T>(t.w, symmetric_times<T>(link.I, t.w));
}

template <typename T>
void inverse_dynamics(const Tree& tree, const Job& job) {
  auto* joints = reinterpret_cast<Joint<T>*>(job.scratch);
  auto* moving = reinterpret_cast<Moving<T>*>(joints + tree.count);
  find_joints(tree, job, joints);
  const Attitude<T> base(job.attitude);
  Vec<T> a0 = load_vec<T>(job.input, 0);
  a0[2] += tree.gravity;
  Moving<T>& root = moving[0];
  root.w = transposed_times<T>(base.R, load_vec<T>(job.angular_velocity, 0));
  root.alpha = transposed_times<T>(base.R, load_vec<T>(job.input, 3));
  root.a = transposed_times<T>(base.R, a0);
  weigh(tree.links[0], root);
  for (int i = 1; i < tree.count; ++i) {
    const Link& link = tree.links[i];
    const Moving<T>& p = moving[link.parent];
    Moving<T>& t = moving[i];
    const T rate = link.ratio * load<T>(job.dtheta, link.dof);
    const T acceleration = link.ratio * load<T>(job.input, 6 + link.dof);
    t.w = p.w;
    t.alpha = p.alpha;
    t.a = p.a + (link.prismatic ? times<T>(p.W, arm_of(link, joints[i].q)) : times<T>(p.W, link.r));
    if (link.turned) {
      t.w = transposed_times<T>(link.E, t.w);
      t.alpha = transposed_times<T>(link.E, t.alpha);
      t.a = transposed_times<T>(link.E, t.a);
    }
    if (link.prismatic) {
      const int k = link.axis, a = (k + 1) % 3, b = (k + 2) % 3;
      t.a[a] += 2.0 * t.w[b] * rate;
      t.a[b] -= 2.0 * t.w[a] * rate;
      t.a[k] += acceleration;
    } else if (link.axis == 0) {
      turn_joint<0>(t, joints[i], rate, acceleration);
    } else if (link.axis == 1) {
      turn_joint<1>(t, joints[i], rate, acceleration);
    } else {
      turn_joint<2>(t, joints[i], rate, acceleration);
    }
    weigh(link, t);
  }
  for (int j = 0; j < tree.dofs; ++j) store(job.output, 6 + j, T{});
  for (int i = tree.count - 1; i > 0; --i) {
    const Link& link = tree.links[i];
    const Moving<T>& t = moving[i];
    Moving<T>& p = moving[link.parent];
    const T along = link.prismatic ? t.f[link.axis] : t.n[link.axis];
    store(job.output, 6 + link.dof, load<T>(job.output, 6 + link.dof) + link.ratio * along);
    Vec<T> f = t.f, n = t.n;
    if (!link.prismatic) {
      const T c = joints[i].c, s = joints[i].s;
      if (link.axis == 0) {
        f = back<0>(f, c, s), n = back<0>(n, c, s);
      } else if (link.axis == 1) {
        f = back<1>(f, c, s), n = back<1>(n, c, s);
      } else {
        f = back<2>(f, c, s), n = back<2>(n, c, s);
      }
    }
    if (link.turned) {
      f = times<T>(link.E, f);
      n = times<T>(link.E, n);
    }
    add_to(p.f, f);
    add_to(p.n, n);
    add_to(p.n, link.prismatic ? cross<T>(arm_of(link, joints[i].q), f) : cross<T>(link.r, f));
  }
  const Vec<T> f = times<T>(base.R, root.f), n = times<T>(base.R, root.n);
  for (int k = 0; k < 3; ++k) {
    store(job.output, k, f[k]);
    store(job.output, 3 + k, n[k]);
  }
}

// An articulated body: f = M a + H alpha + f0, n = H' a + I alpha + n0; M and I symmetric.
template <typename T>
struct Articulated {
  T M[6], H[9], I[6];
  Vec<T> f, n;       // f0, n0
  Vec<T> w, ca, cl;  // its angular velocity and what the rates alone add to alpha and a
  Vec<T> Uf, Un, a, alpha;
  T inverse, drive;
};

template <typename T>
inline void start_body(const Link& link, Articulated<T>& t) {
  const T zero{};
  const double* h = link.moment;
  const double H[9] = {0, h[2], -h[1], -h[2], 0, h[0], h[1], -h[0], 0};  // -[h x]
  for (int k = 0; k < 9; ++k) t.H[k] = zero + H[k];
  for (int k = 0; k < 6; ++k) {
    t.M[k] = zero + (k == 0 || k == 3 || k == 5 ? link.mass : 0.0);
    t.I[k] = zero + link.I[k];
  }
  const T wh = dot(h, t.w), ww = dot(t.w, t.w);
  for (int k = 0; k < 3; ++k) t.f[k] = wh * t.w[k] - ww * h[k];
  t.n = cross<T>(t.w, symmetric_times<T>(link.I, t.w));
}

// Symmetric matrix turned back by the joint about K.
template <int K, typename T>
inline void turn_symmetric(T* S, T c, T s) {
  constexpr int a = (K + 1) % 3, b = (K + 2) % 3;
  T &kk_a = S[kSix[K][a]], &kk_b = S[kSix[K][b]];
  const T ka = kk_a, kb = kk_b;
  kk_a = c * ka - s * kb;
  kk_b = s * ka + c * kb;
  T &aa = S[kSix[a][a]], &bb = S[kSix[b][b]], &ab = S[kSix[a][b]];
  // Rows first: (a, b) -> (c a - s b, s a + c b), then columns likewise.
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

// What is left of the body once its joint about or along K gives way, in the joint's axes.
template <int K, bool kSlides, typename T>
inline void solve_joint(Articulated<T>& t, const Joint<T>& joint, T force, double rotor) {
  for (int j = 0; j < 3; ++j) {
    t.Uf[j] = kSlides ? t.M[kSix[j][K]] : t.H[3 * j + K];
    t.Un[j] = kSlides ? t.H[3 * K + j] : t.I[kSix[j][K]];
  }
  t.inverse = 1.0 / ((kSlides ? t.Uf[K] : t.Un[K]) + rotor);
  t.drive = force - (kSlides ? t.f[K] : t.n[K]);
  Vec<T> vf, vn;
  for (int j = 0; j < 3; ++j) {
    vf[j] = t.inverse * t.Uf[j];
    vn[j] = t.inverse * t.Un[j];
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      t.H[3 * i + j] -= t.Uf[i] * vn[j];
      if (j < i) continue;
      t.M[kSix[i][j]] -= t.Uf[i] * vf[j];
      t.I[kSix[i][j]] -= t.Un[i] * vn[j];
    }
  add_to(t.f, symmetric_times<T>(t.M, t.cl));
  add_to(t.n, transposed_times<T>(t.H, t.cl));
  if (!kSlides) {
    add_to(t.f, times<T>(t.H, t.ca));
    add_to(t.n, symmetric_times<T>(t.I, t.ca));
  }
  for (int j = 0; j < 3; ++j) {
    t.f[j] += t.drive * vf[j];
    t.n[j] += t.drive * vn[j];
  }
  if (kSlides) return;
  turn_symmetric<K>(t.M, joint.c, joint.s);
  turn_symmetric<K>(t.I, joint.c, joint.s);
  turn_general<K>(t.H, joint.c, joint.s);
  t.f = back<K>(t.f, joint.c, joint.s);
  t.n = back<K>(t.n, joint.c, joint.s);
}

// Adds a body, its joint solved and its axes the parent's, at r to the parent.
template <typename T, typename R>
inline void add_to_parent(const Articulated<T>& t, const R& r, Articulated<T>& p) {
  // X = H - M [r x], I + [r x] X + ([r x] H)'.
  T X[9];
  for (int i = 0; i < 3; ++i) {
    const T m0 = t.M[kSix[i][0]], m1 = t.M[kSix[i][1]], m2 = t.M[kSix[i][2]];
    X[3 * i] = t.H[3 * i] - (m1 * r[2] - m2 * r[1]);
    X[3 * i + 1] = t.H[3 * i + 1] - (m2 * r[0] - m0 * r[2]);
    X[3 * i + 2] = t.H[3 * i + 2] - (m0 * r[1] - m1 * r[0]);
  }
  T Y[9], Z[9];  // [r x] X and [r x] H
  for (int j = 0; j < 3; ++j) {
    Y[j] = r[1] * X[6 + j] - r[2] * X[3 + j];
    Y[3 + j] = r[2] * X[j] - r[0] * X[6 + j];
    Y[6 + j] = r[0] * X[3 + j] - r[1] * X[j];
    Z[j] = r[1] * t.H[6 + j] - r[2] * t.H[3 + j];
    Z[3 + j] = r[2] * t.H[j] - r[0] * t.H[6 + j];
    Z[6 + j] = r[0] * t.H[3 + j] - r[1] * t.H[j];
  }
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) p.I[kSix[i][j]] += t.I[kSix[i][j]] + (Y[3 * i + j] + Z[3 * j + i]);
  for (int k = 0; k < 6; ++k) p.M[k] += t.M[k];
  for (int k = 0; k < 9; ++k) p.H[k] += X[k];
  add_to(p.f, t.f);
  add_to(p.n, t.n + cross<T>(r, t.f));
}

// x <- A^-1 x for a symmetric positive definite matrix of six by L D L', the lower part given.
template <typename T>
inline void solve_six(T (&A)[6][6], T (&x)[6]) {
  T inverse[6];
  for (int j = 0; j < 6; ++j) {
    T scaled[6] = {};
    T d = A[j][j];
    for (int k = 0; k < j; ++k) {
      scaled[k] = A[j][k] * A[k][k];
      d = d - scaled[k] * A[j][k];
    }
    A[j][j] = d;
    inverse[j] = 1.0 / d;
    for (int i = j + 1; i < 6; ++i) {
      T sum = A[i][j];
      for (int k = 0; k < j; ++k) sum = sum - A[i][k] * scaled[k];
      A[i][j] = sum * inverse[j];
    }
  }
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k < i; ++k) x[i] = x[i] - A[i][k] * x[k];
  for (int i = 5; i >= 0; --i) {
    x[i] = x[i] * inverse[i];
    for (int k = i + 1; k < 6; ++k) x[i] = x[i] - A[k][i] * x[k];
  }
}

template <int K, typename T>
inline void turn_drift(Articulated<T>& t, const Joint<T>& joint, T rate) {
  constexpr int a = (K + 1) % 3, b = (K + 2) % 3;
  t.w = into<K>(t.w, joint.c, joint.s);
  t.cl = into<K>(t.cl, joint.c, joint.s);
  t.ca[a] = t.w[b] * rate;
  t.ca[b] = -(t.w[a] * rate);
  t.ca[K] = T{};
  t.w[K] += rate;
}

template <typename T>
inline void rates_outwards(const Tree& tree, const Job& job, const Joint<T>* joints,
                           Articulated<T>* bodies) {
  for (int i = 1; i < tree.count; ++i) {
    const Link& link = tree.links[i];
    const Articulated<T>& p = bodies[link.parent];
    Articulated<T>& t = bodies[i];
    const T rate = link.ratio * load<T>(job.dtheta, link.dof);
    const Vec<T> r = arm_of(link, joints[i].q);
    const T wr = dot(p.w, r), ww = dot(p.w, p.w);
    t.w = p.w;
    for (int k = 0; k < 3; ++k) t.cl[k] = wr * p.w[k] - ww * r[k];
    if (link.turned) {
      t.w = transposed_times<T>(link.E, t.w);
      t.cl = transposed_times<T>(link.E, t.cl);
    }
    if (link.prismatic) {
      const int k = link.axis, a = (k + 1) % 3, b = (k + 2) % 3;
      t.ca = {{T{}, T{}, T{}}};
      t.cl[a] += 2.0 * t.w[b] * rate;
      t.cl[b] -= 2.0 * t.w[a] * rate;
    } else if (link.axis == 0) {
      turn_drift<0>(t, joints[i], rate);
    } else if (link.axis == 1) {
      turn_drift<1>(t, joints[i], rate);
    } else {
      turn_drift<2>(t, joints[i], rate);
    }
    start_body(link, t);
  }
}

template <typename T>
void forward_dynamics(const Tree& tree, const Job& job) {
  auto* joints = reinterpret_cast<Joint<T>*>(job.scratch);
  auto* bodies = reinterpret_cast<Articulated<T>*>(joints + tree.count);
  find_joints(tree, job, joints);
  const Attitude<T> base(job.attitude);
  Articulated<T>& root = bodies[0];
  root.w = transposed_times<T>(base.R, load_vec<T>(job.angular_velocity, 0));
  start_body(tree.links[0], root);
  rates_outwards(tree, job, joints, bodies);

  for (int i = tree.count - 1; i > 0; --i) {
    const Link& link = tree.links[i];
    Articulated<T>& t = bodies[i];
    // The joint's own force is told along its axis here: ratio is 1 or -1 where nothing is tied.
    const T force = link.ratio * load<T>(job.input, 6 + link.dof);
    const double rotor = job.rotor ? job.rotor[link.dof] : 0.0;
    const Joint<T>& joint = joints[i];
    switch (link.axis + (link.prismatic ? 3 : 0)) {
      case 0:
        solve_joint<0, false>(t, joint, force, rotor);
        break;
      case 1:
        solve_joint<1, false>(t, joint, force, rotor);
        break;
      case 2:
        solve_joint<2, false>(t, joint, force, rotor);
        break;
      case 3:
        solve_joint<0, true>(t, joint, force, rotor);
        break;
      case 4:
        solve_joint<1, true>(t, joint, force, rotor);
        break;
      default:
        solve_joint<2, true>(t, joint, force, rotor);
        break;
    }
    if (link.turned) {
      turn_symmetric_by(link.E, t.M);
      turn_symmetric_by(link.E, t.I);
      turn_by(link.E, t.H);
      t.f = times<T>(link.E, t.f);
      t.n = times<T>(link.E, t.n);
    }
    if (link.prismatic)
      add_to_parent(t, arm_of(link, joint.q), bodies[link.parent]);
    else
      add_to_parent(t, link.r, bodies[link.parent]);
  }

  T A[6][6], x[6];
  const Vec<T> f = transposed_times<T>(base.R, load_vec<T>(job.input, 0));
  const Vec<T> n = transposed_times<T>(base.R, load_vec<T>(job.input, 3));
  for (int i = 0; i < 3; ++i) {
    x[i] = f[i] - root.f[i];
    x[3 + i] = n[i] - root.n[i];
    for (int j = 0; j < 3; ++j) {
      A[i][j] = root.M[kSix[i][j]];
      A[3 + i][j] = root.H[3 * j + i];
      A[3 + i][3 + j] = root.I[kSix[i][j]];
    }
  }
  solve_six(A, x);
  root.a = {{x[0], x[1], x[2]}};
  root.alpha = {{x[3], x[4], x[5]}};
  for (int i = 1; i < tree.count; ++i) {
    const Link& link = tree.links[i];
    const Articulated<T>& p = bodies[link.parent];
    Articulated<T>& t = bodies[i];
    t.a = p.a + (link.prismatic ? cross<T>(p.alpha, arm_of(link, joints[i].q))
                                : cross<T>(p.alpha, link.r));
    t.alpha = p.alpha;
    if (link.turned) {
      t.a = transposed_times<T>(link.E, t.a);
      t.alpha = transposed_times<T>(link.E, t.alpha);
    }
    if (!link.prismatic) {
      const T c = joints[i].c, s = joints[i].s;
      if (link.axis == 0) {
        t.a = into<0>(t.a, c, s), t.alpha = into<0>(t.alpha, c, s);
      } else if (link.axis == 1) {
        t.a = into<1>(t.a, c, s), t.alpha = into<1>(t.alpha, c, s);
      } else {
        t.a = into<2>(t.a, c, s), t.alpha = into<2>(t.alpha, c, s);
      }
    }
    add_to(t.a, t.cl);
    add_to(t.alpha, t.ca);
    const T ddq = t.inverse * (t.drive - (dot(t.Uf, t.a) + dot(t.Un, t.alpha)));
    (link.prismatic ? t.a : t.alpha)[link.axis] += ddq;
    store(job.output, 6 + link.dof, link.ratio * ddq);
  }
  Vec<T> a = times<T>(base.R, root.a);
  const Vec<T> alpha = times<T>(base.R, root.alpha);
  a[2] -= tree.gravity;
  for (int k = 0; k < 3; ++k) {
    store(job.output, k, a[k]);
    store(job.output, 3 + k, alpha[k]);
  }
}

// The inertia of a subtree about a link's origin; its mass does not change.
template <typename T>
struct Composite {
  Vec<T> h;
  T I[6];
};

template <typename T>
inline void turn_vector_back(const Link& link, const Joint<T>& joint, Vec<T>& v) {
  if (!link.prismatic) {
    if (link.axis == 0)
      v = back<0>(v, joint.c, joint.s);
    else if (link.axis == 1)
      v = back<1>(v, joint.c, joint.s);
    else
      v = back<2>(v, joint.c, joint.s);
  }
  if (link.turned) v = times<T>(link.E, v);
}

template <typename T>
inline void turn_inertia_back(const Link& link, const Joint<T>& joint, T* I) {
  if (!link.prismatic) {
    if (link.axis == 0)
      turn_symmetric<0>(I, joint.c, joint.s);
    else if (link.axis == 1)
      turn_symmetric<1>(I, joint.c, joint.s);
    else
      turn_symmetric<2>(I, joint.c, joint.s);
  }
  if (link.turned) turn_symmetric_by(link.E, I);
}

// Momentum of a subtree per unit rate of its joint: linear f, angular n about the link's origin.
template <typename T>
inline void unit_momentum(const Link& link, const Composite<T>& c, double mass, Vec<T>& f,
                          Vec<T>& n) {
  const int k = link.axis, a = (k + 1) % 3, b = (k + 2) % 3;
  if (link.prismatic) {
    f[k] = T{} + link.ratio * mass;
    f[a] = f[b] = n[k] = T{};
    n[a] = link.ratio * c.h[b];
    n[b] = -link.ratio * c.h[a];
    return;
  }
  f[k] = T{};
  f[a] = -link.ratio * c.h[b];
  f[b] = link.ratio * c.h[a];
  for (int j = 0; j < 3; ++j) n[j] = link.ratio * c.I[kSix[j][k]];
}

template <typename T>
inline void add_entry(double* M, int size, int row, int column, T value) {
  store(M, size * column + row, load<T>(M, size * column + row) + value);
}

template <typename T>
inline void base_block(const Attitude<T>& base, const Composite<T>& root, double mass, int size,
                       double* M) {
  const Vec<T> h = times<T>(base.R, root.h);
  T X[9], S[9] = {root.I[0], root.I[1], root.I[2], root.I[1], root.I[3],
                  root.I[4], root.I[2], root.I[4], root.I[5]};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      X[3 * i + j] =
          base.R[3 * i] * S[j] + base.R[3 * i + 1] * S[3 + j] + base.R[3 * i + 2] * S[6 + j];
  for (int i = 0; i < 3; ++i) {
    store(M, size * i + i, T{} + mass);
    for (int j = 0; j <= i; ++j) {
      const T value = X[3 * i] * base.R[3 * j] + X[3 * i + 1] * base.R[3 * j + 1] +
                      X[3 * i + 2] * base.R[3 * j + 2];
      store(M, size * (3 + i) + 3 + j, value);
      store(M, size * (3 + j) + 3 + i, value);
    }
    const int a = (i + 1) % 3, b = (i + 2) % 3;  // [h x] below, its transpose beside
    store(M, size * a + 3 + b, h[i]);
    store(M, size * b + 3 + a, -h[i]);
    store(M, size * (3 + b) + a, h[i]);
    store(M, size * (3 + a) + b, -h[i]);
  }
}

template <typename T>
void mass_matrix(const Tree& tree, const Job& job) {
  auto* joints = reinterpret_cast<Joint<T>*>(job.scratch);
  auto* bodies = reinterpret_cast<Composite<T>*>(joints + tree.count);
  find_joints(tree, job, joints);
  const int size = 6 + tree.dofs;
  double* M = job.output;
  __builtin_memset(M, 0,
                   sizeof(T) * static_cast<unsigned long>(size) * static_cast<unsigned long>(size));
  const Attitude<T> base(job.attitude);
  for (int i = 0; i < tree.count; ++i) {
    const Link& link = tree.links[i];
    for (int k = 0; k < 3; ++k) bodies[i].h[k] = T{} + link.moment[k];
    for (int k = 0; k < 6; ++k) bodies[i].I[k] = T{} + link.I[k];
  }
  for (int i = tree.count - 1; i > 0; --i) {
    const Link& link = tree.links[i];
    Composite<T>& c = bodies[i];
    Vec<T> f, n;
    unit_momentum(link, c, link.subtree_mass, f, n);
    const int column = 6 + link.dof;
    add_entry(M, size, column, column, link.ratio * (link.prismatic ? f : n)[link.axis]);
    for (int j = i; j > 0; j = tree.links[j].parent) {
      const Link& at = tree.links[j];
      turn_vector_back(at, joints[j], f);
      turn_vector_back(at, joints[j], n);
      add_to(n, at.prismatic ? cross<T>(arm_of(at, joints[j].q), f) : cross<T>(at.r, f));
      const Link& above = tree.links[at.parent];
      if (at.parent == 0) break;
      const T value = above.ratio * (above.prismatic ? f : n)[above.axis];
      add_entry(M, size, 6 + above.dof, column, value);
      add_entry(M, size, column, 6 + above.dof, value);
    }
    f = times<T>(base.R, f);
    n = times<T>(base.R, n);
    for (int k = 0; k < 3; ++k) {
      add_entry(M, size, k, column, f[k]);
      add_entry(M, size, column, k, f[k]);
      add_entry(M, size, 3 + k, column, n[k]);
      add_entry(M, size, column, 3 + k, n[k]);
    }
    // The subtree's inertia to the parent: I + 2 (g.r) - g r' - r g' with g = h + m r / 2.
    Composite<T>& p = bodies[link.parent];
    turn_vector_back(link, joints[i], c.h);
    turn_inertia_back(link, joints[i], c.I);
    const Vec<T> r = arm_of(link, joints[i].q);
    Vec<T> g;
    for (int k = 0; k < 3; ++k) {
      const T mr = link.subtree_mass * r[k];
      g[k] = c.h[k] + 0.5 * mr;
      p.h[k] += c.h[k] + mr;
    }
    const T twice = 2.0 * dot(g, r);
    for (int k = 0; k < 3; ++k)
      for (int j = k; j < 3; ++j) {
        const T shift = g[k] * r[j] + r[k] * g[j];
        p.I[kSix[k][j]] += c.I[kSix[k][j]] + (j == k ? twice - shift : -shift);
      }
  }
  base_block(base, bodies[0], tree.links[0].subtree_mass, size, M);
}

}  // namespace
