#pragma once
// Seam between TreeDynamics and its kernels, which are compiled once per instruction set. Nothing
// here or behind it may use inline functions of other headers: the linker would be free to take
// the copy made for the wider instruction set.

namespace ayumi::kernels {

/// A body of the tree in axes of its own, chosen so that its joint turns or slides along one of
/// them. Lists are row by row; symmetric matrices are xx, xy, xz, yy, yz, zz.
struct Link {
  int parent = -1, dof = -1, axis = 0;
  bool prismatic = false;
  bool turned = false;  ///< the joint frame is turned against the parent
  double ratio = 1, offset = 0;
  double r[3] = {}, E[9] = {};                 ///< joint frame in the parent
  double mass = 0, moment[3] = {}, I[6] = {};  ///< about the link's origin
  double subtree_mass = 0;
};

struct Tree {
  const Link* links = nullptr;
  int count = 0, dofs = 0;
  double gravity = 0;  ///< along -z [m/s^2]
};

/// One state, or `width` states with the numbers of one quantity side by side.
struct Job {
  const double* attitude = nullptr;          ///< x, y, z, w
  const double* angular_velocity = nullptr;  ///< of the base, world
  const double *theta = nullptr, *dtheta = nullptr;
  const double* input = nullptr;  ///< acceleration, or force
  const double* rotor = nullptr;  ///< by dof, one number each; null: none. Forward dynamics only
  double* output = nullptr;       ///< force, or acceleration
  double* scratch = nullptr;      ///< scratch_doubles(), aligned to 64 bytes
};

constexpr int kMaxWidth = 4;
constexpr int scratch_doubles(int links) { return kMaxWidth * 64 * (links + 1); }

struct Kernels {
  const char* name;
  int width;
  void (*inverse)(const Tree&, const Job&);
  void (*forward)(const Tree&, const Job&);
  void (*mass_matrix)(const Tree&, const Job&);
  void (*inverse_wide)(const Tree&, const Job&);
  void (*forward_wide)(const Tree&, const Job&);
  void (*sine_cosine)(const double* angle, double* sine, double* cosine, int count);
};

/// What every processor has: two numbers at once.
const Kernels& plain_kernels();
/// Four at once; null where this was not compiled in. Call only on processors with AVX2.
const Kernels* avx2_kernels();
/// The widest that this processor has.
const Kernels& best_kernels();

}  // namespace ayumi::kernels
