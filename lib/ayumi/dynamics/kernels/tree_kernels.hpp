#pragma once
// Seam between the dynamics and their kernels, which are compiled once per instruction set. Nothing
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
  // Of the body in its own axes, which C turns to those above.
  double drive = 1;     ///< joint coordinate about or along the body's axis per dof
  double along = 1;     ///< -1: that axis points against the one above
  bool skewed = false;  ///< C is not one
  double C[9] = {};     ///< row by row
  double com[3] = {}, about_com[6] = {};
};

struct Tree {
  const Link* links = nullptr;
  int count = 0, dofs = 0;
  double gravity = 0;  ///< along -z [m/s^2]
};

/// Arrays by body: 9 numbers each of `rotation` column by column, 3 of the others. World axes,
/// positions from the base origin.
struct Bodies {
  double *rotation, *position, *axis, *com, *angular_velocity, *velocity;
  double* scratch;  ///< body_scratch_doubles(), aligned to 64 bytes
};
constexpr int body_scratch_doubles(int links) { return 24 * links + 16; }

/// Where entries (a, b) of a symmetric matrix are stored, a and b columns of the generalised
/// velocity: at row[a] + entry[b] where a has the higher rank, with `both` at row[b] + entry[a] as
/// well. entry[b] = b for the base's.
struct Layout {
  const int *row, *entry, *rank;
  bool both;
};

/// Places in the order of a factor, ancestors first: the one above (-1 at the end), how many are
/// above, and where its row begins, a multiple of four.
struct Paths {
  int count;
  const int *parent, *depth, *offset;
};

/// One state, or `width` states with the numbers of one quantity side by side.
struct Job {
  const double* attitude = nullptr;          ///< x, y, z, w
  const double* angular_velocity = nullptr;  ///< of the base, world
  const double *theta = nullptr, *dtheta = nullptr;
  const double* input = nullptr;     ///< acceleration, or force
  const double* rotor = nullptr;     ///< by dof, one number each; null: none. Forward dynamics only
  double* output = nullptr;          ///< force, or acceleration
  double* scratch = nullptr;         ///< scratch_doubles(), aligned to 64 bytes
  const double* velocity = nullptr;  ///< of the base origin, world
};

constexpr int kMaxWidth = 4;
constexpr int scratch_doubles(int links) { return kMaxWidth * 64 * (links + 1); }

/// The joints that move a body, each with the line of a contact's Jacobian that is its own.
struct Chain {
  int count;
  const int *body, *line;
  const Link* links;
  const double *position, *axis;  ///< of Bodies
};

/// A point (from the base origin) and the axes in which it touches: rows of a matrix that stands
/// column by column.
struct Contact {
  const double *point, *axes;
};

struct Kernels {
  const char* name;
  int width;
  void (*inverse)(const Tree&, const Job&);
  void (*forward)(const Tree&, const Job&);
  void (*inverse_wide)(const Tree&, const Job&);
  void (*forward_wide)(const Tree&, const Job&);
  void (*sine_cosine)(const double* angle, double* sine, double* cosine, int count);
  // One state in world axes. `moment`: sum of m com; `momentum`: linear.
  void (*positions)(const Tree&, const Job&, const Bodies&, double* moment);
  void (*velocities)(const Tree&, const Job&, const Bodies&, double* momentum);
  void (*mass_entries)(const Tree&, const Bodies&, const Layout&, double* M);
  void (*newton_euler)(const Tree&, const Job&, const Bodies&);
  // Small matrices: tree_kernels_factor.hpp.
  bool (*factor)(const Paths&, double* rows, double* inverse);
  void (*solve_path)(const Paths&, const double* rows, const double* inverse, int last, int width,
                     double* Y);
  void (*gram)(const double* A, int a, const double* B, int b, int depth, int rows, int columns,
               double* out, int stride);
  void (*multiply_add)(const double* A, int rows, int columns, int stride, const double* x,
                       double* y);
  bool (*solve_positive)(double* A, int size, int stride, double* x);
  void (*contact_lines)(const Contact& contact, const Chain& chain, int stride, double* lines);
};

/// What every processor has: two numbers at once.
const Kernels& plain_kernels();
/// Four at once; null where this was not compiled in. Call only on processors with AVX2.
const Kernels* avx2_kernels();
/// The widest that this processor has.
const Kernels& best_kernels();

}  // namespace ayumi::kernels
