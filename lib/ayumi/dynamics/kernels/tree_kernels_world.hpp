// Part of tree_kernels_body.hpp: one state in world axes about the base origin, where parent and
// child share one frame and the recursions are plain sums:
//   w_i = w_p + s dq,  v_i = v_p + w_p x r,       alpha_i = alpha_p + s ddq + w_p x s dq,
//   a_i = a_p + alpha_p x r + w_p x (w_p x r),    f = m (a_c + g z),
//   n = I alpha + w x I w + c x f,                tau = s . (n_subtree - p x f_subtree).
// A prismatic joint adds s ddq + 2 w_p x s dq to a_i instead of the angular terms. Most bodies
// directly follow their parent in the list. The values that go from the parent to the body then
// stay in registers: a number that has just been stored takes time to be loaded again.

namespace {

using ayumi::kernels::Bodies;
using ayumi::kernels::Chain;
using ayumi::kernels::Contact;
using ayumi::kernels::Layout;

template <int K>
inline Columns turned_about(const Columns& R, double c, double s) {
  constexpr int a = (K + 1) % 3, b = (K + 2) % 3;
  Columns result;
  result.c[K] = R.c[K];
  result.c[a] = c * R.c[a] + s * R.c[b];
  result.c[b] = c * R.c[b] - s * R.c[a];
  return result;
}

struct Frame {
  Columns R;  // attitude in link axes
  Four p;
};

// Computes the pose of a body and stores it. `frame` is the frame of its joint at the angle 0 when
// the function begins, and the frame of the body when it ends (both in link axes). Returns the
// first moment of the body.
template <int K>
inline Four place_body(const Link& link, const Joint<double>& joint, Frame& frame,
                       const Bodies& bodies, int i) {
  Columns R = frame.R;
  Four p = frame.p;
  store_three(bodies.axis + 3 * i, link.along * R.c[K]);
  if (link.prismatic)
    p += joint.q * R.c[K];
  else
    R = turned_about<K>(R, joint.c, joint.s);
  frame = {R, p};
  if (link.skewed)
    R = {{times_four(R, link.C[0], link.C[1], link.C[2]),
          times_four(R, link.C[3], link.C[4], link.C[5]),
          times_four(R, link.C[6], link.C[7], link.C[8])}};
  store_columns(bodies.rotation + 9 * i, R);
  store_three(bodies.position + 3 * i, p);
  const Four com = p + times_four(R, link.com[0], link.com[1], link.com[2]);
  store_three(bodies.com + 3 * i, com);
  return link.mass * com;
}

void body_positions(const Tree& tree, const Job& job, const Bodies& bodies, double* moment) {
  auto* frames = reinterpret_cast<Frame*>(bodies.scratch);
  auto* joints = reinterpret_cast<Joint<double>*>(frames + tree.count);
  find_joints<double>(tree, job, joints);
  const Attitude<double> base(job.attitude);
  const double own_axes[9] = {base.R[0], base.R[3], base.R[6], base.R[1], base.R[4],
                              base.R[7], base.R[2], base.R[5], base.R[8]};
  frames[0] = {load_columns(own_axes), Four{}};
  store_columns(bodies.rotation, frames[0].R);
  const Four zero{};
  store_three(bodies.position, zero);
  store_three(bodies.axis, zero);
  const double* com = tree.links[0].com;
  const Four center = times_four(frames[0].R, com[0], com[1], com[2]);
  store_three(bodies.com, center);
  Four sum = tree.links[0].mass * center;
  Frame frame = frames[0];
  for (int i = 1; i < tree.count; ++i) {
    const Link& link = tree.links[i];
    if (link.parent != i - 1) frame = frames[link.parent];
    Columns& R = frame.R;
    frame.p += times_four(R, link.r[0], link.r[1], link.r[2]);
    if (link.turned)
      R = {{times_four(R, link.E[0], link.E[3], link.E[6]),
            times_four(R, link.E[1], link.E[4], link.E[7]),
            times_four(R, link.E[2], link.E[5], link.E[8])}};
    if (link.axis == 0)
      sum += place_body<0>(link, joints[i], frame, bodies, i);
    else if (link.axis == 1)
      sum += place_body<1>(link, joints[i], frame, bodies, i);
    else
      sum += place_body<2>(link, joints[i], frame, bodies, i);
    frames[i] = frame;
  }
  store_three(moment, sum);
}

void body_velocities(const Tree& tree, const Job& job, const Bodies& bodies, double* momentum) {
  Four w = load_three(job.angular_velocity), v = load_three(job.velocity);
  store_three(bodies.angular_velocity, w);
  store_three(bodies.velocity, v);
  Four sum = tree.links[0].mass * (v + cross_four(w, load_three(bodies.com)));
  for (int i = 1; i < tree.count; ++i) {
    const Link& link = tree.links[i];
    const Four p = load_three(bodies.position + 3 * i);
    if (link.parent != i - 1) {
      w = load_three(bodies.angular_velocity + 3 * link.parent);
      v = load_three(bodies.velocity + 3 * link.parent);
    }
    v += cross_four(w, p - load_three(bodies.position + 3 * link.parent));
    const Four rate = link.drive * job.dtheta[link.dof] * load_three(bodies.axis + 3 * i);
    (link.prismatic ? v : w) += rate;
    store_three(bodies.angular_velocity + 3 * i, w);
    store_three(bodies.velocity + 3 * i, v);
    sum += link.mass * (v + cross_four(w, load_three(bodies.com + 3 * i) - p));
  }
  store_three(momentum, sum);
}

// The first and second moment of a subtree, and the motion that a unit rate of its joint gives it.
struct Subtree {
  Columns I;
  Four h, v, w;
};

inline Columns about_origin(const Link& link, const double* rotation, const Four& c) {
  Columns I = turned(load_columns(rotation), link.about_com);
  const Four mc = link.mass * c;
  const double square = dot_four(mc, c);
  static constexpr double kUnit[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
  for (int k = 0; k < 3; ++k) I.c[k] = I.c[k] + (square * load_four(kUnit[k]) - mc * c[k]);
  return I;
}

// Puts the entry of two columns of different rank, or of a column with itself. If no joints are
// tied, the column of the body that is further out has the higher rank, and no entry is put twice.
template <bool kTied>
inline void put_entry(const Layout& at, double* M, int a, int b, double value) {
  const bool swap = kTied && at.rank[a] < at.rank[b];
  double& entry = M[at.row[swap ? b : a] + at.entry[swap ? a : b]];
  entry = kTied ? entry + value : value;
  if (at.both && (!kTied || a != b)) M[at.row[swap ? a : b] + at.entry[swap ? b : a]] = entry;
}

// Fills each subtree with the body's own inertia and with the motion that a unit rate of its joint
// gives it.
inline void start_subtrees(const Tree& tree, const Bodies& bodies, Subtree* subtrees) {
  for (int i = 0; i < tree.count; ++i) {
    const Link& link = tree.links[i];
    Subtree& t = subtrees[i];
    const Four c = load_three(bodies.com + 3 * i);
    t.I = about_origin(link, bodies.rotation + 9 * i, c);
    t.h = link.mass * c;
    const Four s = link.drive * load_three(bodies.axis + 3 * i);
    if (link.prismatic) {
      t.v = s;
      t.w = Four{};
    } else {
      t.v = cross_four(load_three(bodies.position + 3 * i), s);
      t.w = s;
    }
  }
}

inline void base_entries(const Subtree& root, double mass, const Layout& at, double* M) {
  const Four& h = root.h;
  const double crossed[3][3] = {{0, -h[2], h[1]}, {h[2], 0, -h[0]}, {-h[1], h[0], 0}};
  for (int k = 0; k < 3; ++k) {
    put_entry<false>(at, M, k, k, mass);
    for (int j = 0; j < 3; ++j) put_entry<false>(at, M, 3 + k, j, crossed[k][j]);
    for (int j = 0; j <= k; ++j) put_entry<false>(at, M, 3 + k, 3 + j, root.I.c[j][k]);
  }
}

template <bool kTied>
inline void put_columns(const Tree& tree, const Subtree* subtrees, int i, const Layout& at,
                        double* M) {
  const Link& link = tree.links[i];
  const Subtree& t = subtrees[i];
  Four linear = link.subtree_mass * t.v + cross_four(t.w, t.h);
  Four angular = times_four(t.I, t.w) + cross_four(t.h, t.v);
  const int column = 6 + link.dof;
  for (int j = i; j > 0; j = tree.links[j].parent) {
    const double value = sum_of_three(subtrees[j].v * linear + subtrees[j].w * angular);
    const int other = 6 + tree.links[j].dof;
    put_entry<kTied>(at, M, column, other, kTied && j != i && other == column ? 2 * value : value);
  }
  double* row = M + at.row[column];
  if (kTied) {
    linear += load_three(row);
    angular += load_three(row + 3);
  }
  store_three(row, linear);
  store_three(row + 3, angular);
  if (!at.both) return;
  double* across = M + at.entry[column];
  for (int k = 0; k < 3; ++k) {
    across[at.row[k]] = linear[k];
    across[at.row[3 + k]] = angular[k];
  }
}

// The entries of the mass matrix. Entries that this function leaves out must be zero before.
void mass_entries(const Tree& tree, const Bodies& bodies, const Layout& at, double* M) {
  auto* subtrees = reinterpret_cast<Subtree*>(bodies.scratch);
  start_subtrees(tree, bodies, subtrees);
  const bool tied = tree.count != tree.dofs + 1;
  for (int i = tree.count - 1; i > 0; --i) {
    if (tied)
      put_columns<true>(tree, subtrees, i, at, M);
    else
      put_columns<false>(tree, subtrees, i, at, M);
    const Subtree& t = subtrees[i];
    Subtree& p = subtrees[tree.links[i].parent];
    for (int k = 0; k < 3; ++k) p.I.c[k] += t.I.c[k];
    p.h += t.h;
  }
  base_entries(subtrees[0], tree.links[0].subtree_mass, at, M);
}

struct Loaded {
  Four alpha, a, f, n;
};

void newton_euler(const Tree& tree, const Job& job, const Bodies& bodies) {
  auto* loads = reinterpret_cast<Loaded*>(bodies.scratch);
  const double falling[3] = {job.input[0], job.input[1], job.input[2] + tree.gravity};
  Four a = load_three(falling), alpha = load_three(job.input + 3);
  for (int i = 0; i < tree.count; ++i) {
    const Link& link = tree.links[i];
    Loaded& t = loads[i];
    const Four p = load_three(bodies.position + 3 * i);
    if (i > 0) {
      if (link.parent != i - 1) {
        a = loads[link.parent].a;
        alpha = loads[link.parent].alpha;
      }
      const Four wp = load_three(bodies.angular_velocity + 3 * link.parent);
      const Four r = p - load_three(bodies.position + 3 * link.parent);
      const Four axis = link.drive * load_three(bodies.axis + 3 * i);
      const Four rate = job.dtheta[link.dof] * axis, drate = job.input[6 + link.dof] * axis;
      a = a + cross_four(alpha, r) + cross_four(wp, cross_four(wp, r));
      if (link.prismatic)
        a += drate + 2.0 * cross_four(wp, rate);
      else
        alpha += drate + cross_four(wp, rate);
    }
    t.a = a;
    t.alpha = alpha;
    const Four w = load_three(bodies.angular_velocity + 3 * i);
    const Four com = load_three(bodies.com + 3 * i), c = com - p;
    const Columns I = turned(load_columns(bodies.rotation + 9 * i), link.about_com);
    t.f = link.mass * (a + cross_four(alpha, c) + cross_four(w, cross_four(w, c)));
    t.n = times_four(I, alpha) + cross_four(w, times_four(I, w)) + cross_four(com, t.f);
  }
  for (int j = 0; j < tree.dofs; ++j) job.output[6 + j] = 0;
  Four f = loads[tree.count - 1].f, n = loads[tree.count - 1].n;
  for (int i = tree.count - 1; i > 0; --i) {
    const Link& link = tree.links[i];
    const Four axis = load_three(bodies.axis + 3 * i);
    const Four felt = link.prismatic ? f : n - cross_four(load_three(bodies.position + 3 * i), f);
    job.output[6 + link.dof] += link.drive * dot_four(axis, felt);
    if (link.parent == i - 1) {
      f = loads[i - 1].f + f;
      n = loads[i - 1].n + n;
      continue;
    }
    loads[link.parent].f += f;
    loads[link.parent].n += n;
    f = loads[i - 1].f;
    n = loads[i - 1].n;
  }
  store_three(job.output, f);
  store_three(job.output + 3, n);
}

// Adds the velocity that a unit velocity of the base (lines 0 to 5) and of each joint gives a
// touching point, in the contact's axes: three numbers in each line, with lines `stride` numbers
// apart.
void contact_lines(const Contact& contact, const Chain& chain, int stride, double* lines) {
  const Columns axes = load_columns(contact.axes);
  const double* q = contact.point;
  const Four p = load_three(q);
  const auto add = [&](int line, const Four& v) {
    double* to = lines + line * stride;
    store_three(to, load_three(to) + v);
  };
  for (int k = 0; k < 3; ++k) add(k, axes.c[k]);
  add(3, times_four(axes, 0, -q[2], q[1]));
  add(4, times_four(axes, q[2], 0, -q[0]));
  add(5, times_four(axes, -q[1], q[0], 0));
  for (int k = 0; k < chain.count; ++k) {
    const int b = chain.body[k];
    const Link& link = chain.links[b];
    const Four s = link.drive * load_three(chain.axis + 3 * b);
    add(chain.line[k],
        times_four(axes,
                   link.prismatic ? s : cross_four(s, p - load_three(chain.position + 3 * b))));
  }
}

}  // namespace
