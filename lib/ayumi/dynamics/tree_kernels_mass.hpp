// Part of tree_kernels_body.hpp: composite rigid bodies.

namespace {

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
