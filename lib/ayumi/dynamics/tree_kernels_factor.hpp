// Part of tree_kernels_body.hpp: the sparse factor M = L' L. The row of a place holds its path from
// the root: an ancestor's path is the beginning of it, so all runs over whole beginnings. Rows are
// filled up to fours with numbers of no meaning.

namespace {

using ayumi::kernels::Paths;

bool factor_rows(const Paths& paths, double* rows, double* inverse) {
  for (int k = paths.count - 1; k >= 0; --k) {
    double* row = rows + paths.offset[k];
    const int depth = paths.depth[k];
    const double pivot = row[depth];
    if (!(pivot > 0)) return false;
    row[depth] = __builtin_sqrt(pivot);
    inverse[k] = 1.0 / row[depth];
    for (int t = 0; t < depth; ++t) row[t] *= inverse[k];
    for (int i = paths.parent[k], t = depth - 1; t >= 0; i = paths.parent[i], --t) {
      double* above = rows + paths.offset[i];
      const double share = row[t];
      for (int s = 0; s <= t; s += 4)
        store_four(above + s, load_four(above + s) - share * load_four(row + s));
    }
  }
  return true;
}

// Y <- L^-T Y for `width` columns (a multiple of four) that are zero but on the path to `last`;
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

// out = A' B of matrices with `depth` rows, row by row, of widths a and b (multiples of four); out
// column by column with `a` numbers each.
void gram(const double* A, int a, const double* B, int b, int depth, double* out) {
  for (int j = 0; j < b; j += 4)
    for (int i = 0; i < a; i += 4) {
      Four sum[4] = {};
      for (int t = 0; t < depth; ++t) {
        const Four x = load_four(A + t * a + i);
        const double* y = B + t * b + j;
        for (int k = 0; k < 4; ++k) sum[k] += x * y[k];
      }
      for (int k = 0; k < 4; ++k) store_four(out + (j + k) * a + i, sum[k]);
    }
}

// x <- A^-1 x of a symmetric positive definite matrix of `size` rows by its lower triangle, columns
// `stride` (a multiple of four) apart; A becomes its factor. False where it is not safely positive;
// x is as before then.
bool solve_positive(double* A, int size, int stride, double* x) {
  double largest = 0;
  for (int k = 0; k < size; ++k)
    if (A[k * stride + k] > largest) largest = A[k * stride + k];
  for (int j = 0; j < size; ++j) {
    double* column = A + j * stride;
    for (int i = j & ~3; i < size; i += 4) {
      Four sum = load_four(column + i);
      for (int k = 0; k < j; ++k) sum -= A[k * stride + j] * load_four(A + k * stride + i);
      store_four(column + i, sum);
    }
    if (!(column[j] > 1e-14 * largest)) return false;
    const double inverse = 1.0 / __builtin_sqrt(column[j]);
    for (int i = j; i < size; ++i) column[i] *= inverse;
  }
  for (int k = 0; k < size; ++k) {
    const double* column = A + k * stride;
    x[k] /= column[k];
    for (int i = k + 1; i < size; ++i) x[i] -= column[i] * x[k];
  }
  for (int k = size - 1; k >= 0; --k) {
    const double* column = A + k * stride;
    for (int i = k + 1; i < size; ++i) x[k] -= column[i] * x[i];
    x[k] /= column[k];
  }
  return true;
}

}  // namespace
