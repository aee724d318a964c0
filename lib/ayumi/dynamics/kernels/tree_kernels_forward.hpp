// Part of tree_kernels_body.hpp: articulated bodies.

namespace {

// An articulated body: f = M a + H alpha + f0, n = H' a + I alpha + n0, with symmetric M and I.
template <typename T>
struct Articulated {
  T M[6], H[9], I[6];
  Vec<T> f, n;       // f0 and n0
  Vec<T> w, ca, cl;  // angular velocity of the body, and what the rates alone add to alpha and a
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

// Eliminates the acceleration of the joint about or along axis K from the inertia and the bias
// force of an articulated body, and turns them into the axes of the joint frame.
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

// Adds a body to its parent. The body's joint is already solved, its axes are those of the parent,
// and it is at r.
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

// x <- A^-1 x for a symmetric positive definite matrix of six rows by L D L'. The lower part is
// given.
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
    // The joint's own force is expressed along its axis here: if no joints are tied, the ratio is 1
    // or -1.
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

}  // namespace
