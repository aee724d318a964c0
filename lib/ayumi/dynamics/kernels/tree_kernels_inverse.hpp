// Part of tree_kernels_body.hpp: recursive Newton-Euler.

namespace {

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

}  // namespace
