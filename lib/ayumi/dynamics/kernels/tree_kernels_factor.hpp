// Part of tree_kernels_body.hpp: the sparse factor M = L' L. The row of a place holds its path from
// the root. The path of an ancestor is the beginning of this path, so that all loops run over
// beginnings of rows. Rows are filled up to a multiple of four with numbers that have no meaning.

namespace {

using ayumi::kernels::Paths;

bool factor_rows(const Paths& paths, double* rows, double* inverse) {
  for (int k = paths.count - 1; k >= 0; --k) {
    double* row = rows + paths.offset[k];
    const int depth = paths.depth[k];
    const double pivot = row[depth];
    if (!(pivot > 0)) return false;
    const double root = __builtin_sqrt(pivot);
    inverse[k] = root * (1.0 / pivot);  // neither factor waits for the other
    for (int t = 0; t < depth; t += 4) store_four(row + t, inverse[k] * load_four(row + t));
    row[depth] = root;
    for (int i = paths.parent[k], t = depth - 1; t >= 0; i = paths.parent[i], --t) {
      double* above = rows + paths.offset[i];
      const double share = row[t];
      for (int s = 0; s <= t; s += 4)
        store_four(above + s, load_four(above + s) - share * load_four(row + s));
    }
  }
  return true;
}

// Y <- L^-T Y for `width` columns (a multiple of four) that are zero except on the path to `last`;
// Y has a row for every entry of that path.
void solve_path(const Paths& paths, const double* rows, const double* inverse, int last, int width,
                double* Y) {
  for (int k = last, t = paths.depth[last]; t >= 0; k = paths.parent[k], --t) {
    const double* row = rows + paths.offset[k];
    double* own = Y + t * width;
    for (int c = 0; c < width; c += 4) store_four(own + c, inverse[k] * load_four(own + c));
    for (int s = 0; s < t; ++s) {
      double* to = Y + s * width;
      for (int c = 0; c < width; c += 4)
        store_four(to + c, load_four(to + c) - row[s] * load_four(own + c));
    }
  }
}

inline double sum_of(const Four& x) { return (x[0] + x[1]) + (x[2] + x[3]); }

struct Tile {
  Four c0, c1, c2, c3;
};

inline void store_part(const Tile& tile, int rows, int columns, double* out, int stride) {
  const Four c[4] = {tile.c0, tile.c1, tile.c2, tile.c3};
  for (int k = 0; k < 4 && k < columns; ++k)
    for (int l = 0; l < 4 && l < rows; ++l) out[k * stride + l] = c[k][l];
}

// Writes the other half of a symmetric product: column k of a tile becomes a row.
inline void store_across(const Tile& tile, double* out, int stride) {
  const Four a = __builtin_shufflevector(tile.c0, tile.c1, 0, 4, 2, 6),
             b = __builtin_shufflevector(tile.c0, tile.c1, 1, 5, 3, 7),
             c = __builtin_shufflevector(tile.c2, tile.c3, 0, 4, 2, 6),
             d = __builtin_shufflevector(tile.c2, tile.c3, 1, 5, 3, 7);
  store_four(out, __builtin_shufflevector(a, c, 0, 1, 4, 5));
  store_four(out + stride, __builtin_shufflevector(b, d, 0, 1, 4, 5));
  store_four(out + 2 * stride, __builtin_shufflevector(a, c, 2, 3, 6, 7));
  store_four(out + 3 * stride, __builtin_shufflevector(b, d, 2, 3, 6, 7));
}

// One tile of a product, and two tiles one below the other, whose sums do not wait for each other.
inline void tile_of(const double* x, int a, const double* y, int b, int depth, Tile& sum) {
  for (int t = 0; t < depth; ++t, x += a, y += b) {
    const Four v = load_four(x);
    sum.c0 += v * y[0];
    sum.c1 += v * y[1];
    sum.c2 += v * y[2];
    sum.c3 += v * y[3];
  }
}
inline void tiles_of(const double* x, int a, const double* y, int b, int depth, Tile& sum,
                     Tile& below) {
  for (int t = 0; t < depth; ++t, x += a, y += b) {
    const Four v = load_four(x), w = load_four(x + 4);
    sum.c0 += v * y[0];
    below.c0 += w * y[0];
    sum.c1 += v * y[1];
    below.c1 += w * y[1];
    sum.c2 += v * y[2];
    below.c2 += w * y[2];
    sum.c3 += v * y[3];
    below.c3 += w * y[3];
  }
}

inline void store_tile(const Tile& sum, double* to, int stride) {
  store_four(to, sum.c0);
  store_four(to + stride, sum.c1);
  store_four(to + 2 * stride, sum.c2);
  store_four(to + 3 * stride, sum.c3);
}

// out(i, j) = sum over t of A(t, i) B(t, j) for i < rows, j < columns. A and B have `depth` lines
// of a and b numbers (multiples of four), and the columns of `out` are `stride` numbers apart.
void gram(const double* A, int a, const double* B, int b, int depth, int rows, int columns,
          double* out, int stride) {
  // For the product of a matrix with itself, filled up to a multiple of four, half of it is enough.
  const bool half = A == B && rows == columns && (rows & 3) == 0;
  constexpr bool kTwo = sizeof(Wide) == sizeof(Four);  // otherwise there are too few registers
  for (int j = 0; j < columns; j += 4)
    for (int i = half ? j : 0; i < rows; i += 4) {
      double* to = out + j * stride + i;
      Tile sum = {};
      if (kTwo && !half && i + 8 <= rows && j + 4 <= columns) {
        Tile below = {};
        tiles_of(A + i, a, B + j, b, depth, sum, below);
        store_tile(sum, to, stride);
        store_tile(below, to + 4, stride);
        i += 4;
        continue;
      }
      tile_of(A + i, a, B + j, b, depth, sum);
      if (i + 4 > rows || j + 4 > columns) {
        store_part(sum, rows - i, columns - j, to, stride);
        continue;
      }
      store_tile(sum, to, stride);
      if (half && i > j) store_across(sum, out + i * stride + j, stride);
    }
}

// y <- y + A x for a matrix of `rows` by `columns`, whose columns are `stride` numbers apart.
void multiply_add(const double* A, int rows, int columns, int stride, const double* x, double* y) {
  int i = 0;
  for (; i + 4 <= rows; i += 4) {
    Four sum = load_four(y + i);
    for (int k = 0; k < columns; ++k) sum += x[k] * load_four(A + k * stride + i);
    store_four(y + i, sum);
  }
  for (; i < rows; ++i)
    for (int k = 0; k < columns; ++k) y[i] += x[k] * A[k * stride + i];
}

// Subtracts from the four columns j to j + 3 their parts along the columns before them.
inline void subtract_columns(double* A, int size, int stride, int j) {
  for (int i = j; i < size; i += 4) {
    Four sum[4];
    for (int k = 0; k < 4; ++k) sum[k] = load_four(A + (j + k) * stride + i);
    for (int t = 0; t < j; ++t) {
      const double* column = A + t * stride;
      const Four x = column[t] * load_four(column + i);
      for (int k = 0; k < 4; ++k) sum[k] -= x * column[j + k];
    }
    for (int k = 0; k < 4; ++k) store_four(A + (j + k) * stride + i, sum[k]);
  }
}

// x <- A^-1 x for a symmetric positive definite matrix of `size` rows, given by its lower triangle.
// Its columns are `stride` numbers apart; `stride` is `size` rounded up to a multiple of four.
// There are `stride` columns, and x has `stride` entries. A becomes C of A = C D^-1 C', where D is
// the diagonal of C, with 1/D in its place: a square root or a quotient in each step would delay
// the whole solution. Returns false if A is not safely positive; x is then unchanged.
bool solve_positive(double* A, int size, int stride, double* x) {
  double largest = 0;
  for (int k = 0; k < size; ++k)
    if (A[k * stride + k] > largest) largest = A[k * stride + k];
  for (int j = 0; j < size; ++j) {
    if ((j & 3) == 0) subtract_columns(A, size, stride, j);
    double* column = A + j * stride;
    const int block = j & ~3;
    for (int t = block; t < j; ++t) {
      const double* before = A + t * stride;
      const double share = before[t] * before[j];
      for (int i = block; i < size; i += 4)
        store_four(column + i, load_four(column + i) - share * load_four(before + i));
    }
    if (!(column[j] > 1e-14 * largest)) return false;
    column[j] = 1.0 / column[j];
  }
  // In each block of four, the numbers above the diagonal have no meaning.
  for (int k = 0; k < size; ++k) {
    const double* column = A + k * stride;
    const double share = x[k] * column[k];
    int i = k + 1;
    for (; i < size && (i & 3); ++i) x[i] -= column[i] * share;
    for (; i < size; i += 4) store_four(x + i, load_four(x + i) - share * load_four(column + i));
    x[k] = share;
  }
  for (int k = size; k < stride; ++k) x[k] = 0;
  for (int k = size - 1; k >= 0; --k) {
    const double* column = A + k * stride;
    double sum = 0;
    int i = k + 1;
    for (; i < size && (i & 3); ++i) sum += column[i] * x[i];
    if (i < size) {
      Four rest{};
      for (; i < size; i += 4) rest += load_four(column + i) * load_four(x + i);
      sum += sum_of(rest);
    }
    x[k] -= column[k] * sum;
  }
  return true;
}

}  // namespace
