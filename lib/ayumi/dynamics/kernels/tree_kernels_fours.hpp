// Part of tree_kernels_body.hpp: vectors of the world in one register of four numbers, the last of
// which has no meaning (in two registers of two if the processor has no wider ones).

namespace {

typedef double Four __attribute__((vector_size(32)));
typedef double Two __attribute__((vector_size(16)));

inline Four load_four(const double* from) {
  Four x;
  __builtin_memcpy(&x, from, sizeof x);
  return x;
}
inline void store_four(double* to, const Four& x) { __builtin_memcpy(to, &x, sizeof x); }
inline Four load_three(const double* from) {
  Two low;
  __builtin_memcpy(&low, from, sizeof low);
  const Two high = {from[2], from[2]};
  return __builtin_shufflevector(low, high, 0, 1, 2, 3);
}
inline void store_three(double* to, const Four& x) {
  const Two low = __builtin_shufflevector(x, x, 0, 1);
  __builtin_memcpy(to, &low, sizeof low);
  to[2] = x[2];
}
inline Four next(const Four& a) { return __builtin_shufflevector(a, a, 1, 2, 0, 3); }
inline Four cross_four(const Four& a, const Four& b) { return next(a * next(b) - next(a) * b); }
inline double sum_of_three(const Four& t) { return (t[0] + t[1]) + t[2]; }
inline double dot_four(const Four& a, const Four& b) { return sum_of_three(a * b); }

// A matrix of three by three, stored by columns.
struct Columns {
  Four c[3];
};
inline Four times_four(const Columns& m, double x, double y, double z) {
  return m.c[0] * x + m.c[1] * y + m.c[2] * z;
}
inline Four times_four(const Columns& m, const Four& v) { return times_four(m, v[0], v[1], v[2]); }
inline Columns load_columns(const double* from) {
  return {{load_four(from), load_four(from + 3), load_three(from + 6)}};
}
inline void store_columns(double* to, const Columns& m) {
  store_four(to, m.c[0]);  // the fourth number is overwritten by the next column
  store_four(to + 3, m.c[1]);
  store_three(to + 6, m.c[2]);
}
// R S R' for a symmetric S, given by six numbers.
inline Columns turned(const Columns& R, const double* S) {
  const Columns X = {{times_four(R, S[0], S[1], S[2]), times_four(R, S[1], S[3], S[4]),
                      times_four(R, S[2], S[4], S[5])}};
  return {{times_four(X, R.c[0][0], R.c[1][0], R.c[2][0]),
           times_four(X, R.c[0][1], R.c[1][1], R.c[2][1]),
           times_four(X, R.c[0][2], R.c[1][2], R.c[2][2])}};
}

}  // namespace
