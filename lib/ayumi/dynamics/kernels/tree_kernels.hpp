#pragma once
// The interface between the dynamics and their kernels, which are compiled once per instruction
// set. Neither this file nor the kernels may use inline functions of other headers: the linker
// would be free to take the copy made for the wider instruction set.

namespace ayumi::kernels {

/// A body of the tree in axes of its own, chosen so that its joint turns or slides along one of
/// them. Lists are row by row; symmetric matrices are xx, xy, xz, yy, yz, zz.
struct Link {
  int parent = -1, dof = -1, axis = 0;
  bool prismatic = false;
  bool turned = false;  ///< the joint frame is turned relative to the parent
  double ratio = 1, offset = 0;
  double r[3] = {}, E[9] = {};  ///< position and turn of the joint frame in the parent
  /// Mass, first moment and inertia about the link's origin.
  double mass = 0, moment[3] = {}, I[6] = {};
  double subtree_mass = 0;
  // The numbers from here to C concern the body in its own axes, which C turns to the axes above.
  double drive = 1;     ///< joint coordinate about or along the body's axis per dof
  double along = 1;     ///< -1 if that axis points against the one above
  bool skewed = false;  ///< C is not the unit matrix
  double C[9] = {};     ///< the turn C, row by row
  double com[3] = {}, about_com[6] = {};
};

struct Tree {
  const Link* links = nullptr;
  int count = 0, dofs = 0;
  double gravity = 0;  ///< gravity along -z [m/s^2]
};

/// Arrays by body: `rotation` has 9 numbers for each, column by column, and the others have 3. They
/// are in world axes, with positions from the base origin.
struct Bodies {
  double *rotation, *position, *axis, *com, *angular_velocity, *velocity;
  double* scratch;  ///< body_scratch_doubles() numbers, aligned to 64 bytes
};
constexpr int body_scratch_doubles(int links) { return 24 * links + 16; }

/// The place where entry (a, b) of a symmetric matrix is stored, for columns a and b of the
/// generalised velocity. If a has the higher rank, it is row[a] + entry[b]. With `both`, the entry
/// is also stored at row[b] + entry[a]. For columns of the base, entry[b] = b.
struct Layout {
  const int *row, *entry, *rank;
  bool both;
};

/// Places in the order of a factor, ancestors first: the place above (-1 at the end), the number of
/// places above, and the beginning of its row, a multiple of four.
struct Paths {
  int count;
  const int *parent, *depth, *offset;
};

/// One state, or `width` states with the numbers of one quantity side by side.
struct Job {
  const double* attitude = nullptr;          ///< quaternion x, y, z, w of the base
  const double* angular_velocity = nullptr;  ///< angular velocity of the base, world axes
  const double *theta = nullptr, *dtheta = nullptr;
  const double* input = nullptr;  ///< acceleration or force
  /// Rotor inertia by dof, one number each, for forward dynamics only; null if there are none.
  const double* rotor = nullptr;
  double* output = nullptr;          ///< force or acceleration
  double* scratch = nullptr;         ///< scratch_doubles() numbers, aligned to 64 bytes
  const double* velocity = nullptr;  ///< velocity of the base origin, world axes
};

constexpr int kMaxWidth = 4;
constexpr int scratch_doubles(int links) { return kMaxWidth * 64 * (links + 1); }

/// The joints that move a body, each with its line of a contact's Jacobian.
struct Chain {
  int count;
  const int *body, *line;
  const Link* links;
  const double *position, *axis;  ///< arrays of Bodies
};

/// A point (from the base origin) and the axes in which it touches: rows of a matrix that is stored
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
  // The next functions work on one state in world axes. `moment` is the sum of m com, and
  // `momentum` the linear momentum.
  void (*positions)(const Tree&, const Job&, const Bodies&, double* moment);
  void (*velocities)(const Tree&, const Job&, const Bodies&, double* momentum);
  void (*mass_entries)(const Tree&, const Bodies&, const Layout&, double* M);
  void (*newton_euler)(const Tree&, const Job&, const Bodies&);
  // The next functions work on small matrices; they are described in tree_kernels_factor.hpp.
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

/// The kernels that every processor can run, with two numbers at once.
const Kernels& plain_kernels();
/// The kernels with four numbers at once; null if they were not compiled in. They may only be
/// called on processors with AVX2.
const Kernels* avx2_kernels();
/// The widest kernels that this processor can run.
const Kernels& best_kernels();

}  // namespace ayumi::kernels
