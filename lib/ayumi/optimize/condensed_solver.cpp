// The face is that of the solver MA27, which Ipopt's loader takes from outside: analyse the
// pattern, factor, solve. All memory is Ipopt's: `ikeep` (3 n) goes from analysis to factorization,
// `iw` and `a` from there to the solution, so that nothing is kept here.
//   ikeep  class or place of every unknown [n], width of the band, number of places
//   iw     the same, then rows and columns of the nonzeros, from 0
//   a      values of the nonzeros, pivots [n], then by block: diagonal block, block below it
#include "ayumi/optimize/condensed_solver.hpp"

#include <coin/HSLLoader.h>

#include <Eigen/Dense>
#include <algorithm>
#include <numeric>
#include <vector>

namespace ayumi {

namespace {

using Eigen::Index;
using Eigen::Map;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Classes of unknowns that are eliminated alone; the others have a place >= 0 in the band.
constexpr int kSlack = -1;  // has a single neighbour
constexpr int kRow = -2;    // has slacks and places for neighbours

struct Nonzeros {
  int count;
  const int *rows, *columns;
  int first;  // index of the first row
  int row(int k) const { return rows[k] - first; }
  int column(int k) const { return columns[k] - first; }
};

struct Band {
  int width = 1, places = 0;
  int blocks() const { return (places + width - 1) / width; }
  Index size() const { return 2 * static_cast<Index>(blocks()) * width * width; }
};

// Multipliers are the last unknowns; two that look like rows and meet are a variable and one.
std::vector<int> classes(int n, const Nonzeros& entries) {
  constexpr int kNone = -1, kMany = -2;
  std::vector<int> neighbour(n, kNone), result(n, 0);
  auto meet = [&](int i, int j) {
    neighbour[i] = neighbour[i] == kNone || neighbour[i] == j ? j : kMany;
  };
  for (int k = 0; k < entries.count; ++k) {
    const int i = entries.row(k), j = entries.column(k);
    if (i == j) continue;
    meet(i, j);
    meet(j, i);
  }
  for (int i = 0; i < n; ++i) {
    const int j = neighbour[i];
    if (j < i || result[i] == kRow || result[j] == kSlack) continue;
    result[i] = kSlack;
    result[j] = kRow;
  }
  for (int k = 0; k < entries.count; ++k) {
    const int i = entries.row(k), j = entries.column(k);
    if (i != j && result[i] == kRow && result[j] == kRow) result[std::min(i, j)] = 0;
  }
  return result;
}

// Calls use(row unknown, other unknown) for both sides of every nonzero off the diagonal.
template <class Use>
void for_sides(const Nonzeros& entries, const Use& use) {
  for (int k = 0; k < entries.count; ++k) {
    const int i = entries.row(k), j = entries.column(k);
    if (i == j) continue;
    use(i, j);
    use(j, i);
  }
}

// Puts places in order of the lowest unknown that each one meets in a row, which is time order
// where the unknowns come in it, and returns the band.
Band place(int n, const Nonzeros& entries, std::vector<int>& place) {
  place = classes(n, entries);
  std::vector<int> low(n);
  std::iota(low.begin(), low.end(), 0);
  for (int i = 0; i < n; ++i)
    if (place[i] == kRow) low[i] = n;
  auto take_lower = [&](int i, int j) {  // a row from its unknowns, an unknown from others
    if (place[i] != kSlack && place[j] >= 0) low[i] = std::min(low[i], j);
  };
  for_sides(entries, take_lower);
  for_sides(entries, [&](int i, int j) {
    if (place[i] >= 0 && place[j] == kRow) low[i] = std::min(low[i], low[j]);
  });
  std::vector<int> order;
  for (int i = 0; i < n; ++i)
    if (place[i] >= 0) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return low[i] < low[j]; });
  Band band;
  band.places = static_cast<int>(order.size());
  for (int p = 0; p < band.places; ++p) place[order[p]] = p;

  std::vector<int> first(n, n), last(n, -1);  // places that meet in a row
  for_sides(entries, [&](int i, int j) {
    if (place[j] < 0 || place[i] == kSlack) return;
    first[i] = std::min(first[i], place[j]);
    last[i] = std::max(last[i], place[j]);
  });
  for (int i = 0; i < n; ++i)
    if (last[i] >= 0)
      band.width =
          std::max({band.width, last[i] - first[i],
                    place[i] >= 0 ? std::max(place[i] - first[i], last[i] - place[i]) : 0});
  return band;
}

// What factor and solve see of Ipopt's arrays.
struct Factors {
  int n;
  const int* place;
  Band band;
  Nonzeros entries;
  double *values, *pivot, *blocks;

  Factors(int size, double* a, const int* iw)
      : n(size),
        place(iw),
        band{iw[n], iw[n + 1]},
        entries{iw[n + 2], iw + n + 3, iw + n + 3 + iw[n + 2], 0},
        values(a),
        pivot(a + entries.count),
        blocks(pivot + n) {}

  Map<MatrixXd> diagonal(int block) const { return map(2 * block); }
  Map<MatrixXd> below(int block) const { return map(2 * block + 1); }
  // Column `j` of the band from row `i` to the end of `i`'s block.
  double* at(int i, int j) const {
    const int block = j / band.width, row = i / band.width;
    const Index which = 2 * block + (row > block ? 1 : 0);
    return blocks + (which * band.width + j % band.width) * band.width + i % band.width;
  }

 private:
  Map<MatrixXd> map(Index which) const {
    return {blocks + which * band.width * band.width, band.width, band.width};
  }
};

// Of one row: the unknowns in the band and their values, by k-th row of `first` on.
struct Rows {
  std::vector<int> first, place;
  std::vector<double> value;

  explicit Rows(const Factors& f) : first(f.n + 1, 0) {
    auto each = [&](const auto& use) {
      for (int k = 0; k < f.entries.count; ++k) {
        const int i = f.entries.row(k), j = f.entries.column(k);
        if (f.place[i] == kRow && f.place[j] >= 0) use(i, f.place[j], f.values[k]);
        if (f.place[j] == kRow && f.place[i] >= 0) use(j, f.place[i], f.values[k]);
      }
    };
    each([&](int row, int, double) { ++first[row + 1]; });
    std::partial_sum(first.begin(), first.end(), first.begin());
    place.resize(first.back());
    value.resize(first.back());
    std::vector<int> next(first.begin(), first.end() - 1);
    each([&](int row, int p, double v) {
      place[next[row]] = p;
      value[next[row]++] = v;
    });
  }
};

// Pivots of slacks and rows; adds what concerns places alone to the band.
void eliminate_slacks(const Factors& f) {
  std::fill_n(f.pivot, f.n, 0.0);
  for (int k = 0; k < f.entries.count; ++k)
    if (f.entries.row(k) == f.entries.column(k)) f.pivot[f.entries.row(k)] += f.values[k];
  std::vector<double> link(f.n, 0.0);  // of a slack to its neighbour; nonzeros may come in parts
  std::vector<int> neighbour(f.n, -1);
  for (int k = 0; k < f.entries.count; ++k) {
    const int i = f.entries.row(k), j = f.entries.column(k);
    if (i == j) continue;
    const int slack = f.place[i] == kSlack ? i : j;
    if (f.place[slack] == kSlack) {
      link[slack] += f.values[k];
      neighbour[slack] = i + j - slack;
    } else if (f.place[i] >= 0 && f.place[j] >= 0) {
      *f.at(std::max(f.place[i], f.place[j]), std::min(f.place[i], f.place[j])) += f.values[k];
    }
  }
  for (int i = 0; i < f.n; ++i)
    if (neighbour[i] >= 0) f.pivot[neighbour[i]] -= link[i] * link[i] / f.pivot[i];
  for (int i = 0; i < f.n; ++i)
    if (f.place[i] >= 0) *f.at(f.place[i], f.place[i]) += f.pivot[i];
  for (int p = f.band.places; p < f.band.blocks() * f.band.width; ++p) *f.at(p, p) = 1;
}

// Adds  -v v' / pivot  of every row.
void eliminate_rows(const Factors& f) {
  const Rows rows(f);
  VectorXd v = VectorXd::Zero(f.band.width + 1);
  for (int i = 0; i < f.n; ++i) {
    if (f.place[i] != kRow || rows.first[i] == rows.first[i + 1]) continue;
    int low = f.band.places, high = 0;
    for (int k = rows.first[i]; k < rows.first[i + 1]; ++k) {
      low = std::min(low, rows.place[k]);
      high = std::max(high, rows.place[k]);
    }
    v.head(high - low + 1).setZero();
    for (int k = rows.first[i]; k < rows.first[i + 1]; ++k) v[rows.place[k] - low] += rows.value[k];
    for (int j = low; j <= high; ++j) {
      const double factor = -v[j - low] / f.pivot[i];
      if (factor == 0) continue;
      const int edge = (j / f.band.width + 1) * f.band.width;  // first row of the next block
      const int here = std::min(high + 1, edge) - j, there = std::max(0, high + 1 - edge);
      Map<VectorXd>(f.at(j, j), here) += factor * v.segment(j - low, here);
      if (there > 0) Map<VectorXd>(f.at(edge, j), there) += factor * v.segment(edge - low, there);
    }
  }
}

bool factor_band(const Factors& f) {
  for (int b = 0; b < f.band.blocks(); ++b) {
    Map<MatrixXd> own = f.diagonal(b);
    if (b > 0) own.selfadjointView<Eigen::Lower>().rankUpdate(f.below(b - 1), -1);
    Eigen::Ref<MatrixXd> in_place = own;
    if (Eigen::LLT<Eigen::Ref<MatrixXd>>(in_place).info() != Eigen::Success) return false;
    if (b + 1 == f.band.blocks()) continue;
    Map<MatrixXd> next = f.below(b);
    own.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(next);
  }
  return true;
}

void solve_band(const Factors& f, VectorXd& x) {
  const int width = f.band.width, blocks = f.band.blocks();
  for (int b = 0; b < blocks; ++b) {
    auto own = x.segment(b * width, width);
    if (b > 0) own -= f.below(b - 1) * x.segment((b - 1) * width, width);
    f.diagonal(b).triangularView<Eigen::Lower>().solveInPlace(own);
  }
  for (int b = blocks - 1; b >= 0; --b) {
    auto own = x.segment(b * width, width);
    if (b + 1 < blocks) own -= f.below(b).transpose() * x.segment((b + 1) * width, width);
    f.diagonal(b).triangularView<Eigen::Lower>().transpose().solveInPlace(own);
  }
}

// ---- the face. Of `info`: 0 outcome (0 good, -5 singular), 4 and 5 lengths of a and iw, 14 the
// number of negative pivots.

void analyse(int* n, int* nz, const int* rows, const int* columns, int*, int*, int* ikeep, int*,
             int* steps, int*, int*, double*, int* info, double*) {
  const Nonzeros entries{*nz, rows, columns, 1};
  std::vector<int> places;
  const Band band = place(*n, entries, places);
  std::copy(places.begin(), places.end(), ikeep);
  ikeep[*n] = band.width;
  ikeep[*n + 1] = band.places;
  *steps = 1;
  std::fill_n(info, 20, 0);
  info[4] = static_cast<int>(*nz + *n + band.size());
  info[5] = *n + 3 + 2 * *nz;
}

void factor(int* n, int* nz, const int* rows, const int* columns, double* a, int*, int* iw, int*,
            int* ikeep, int*, int* front, int*, int*, double*, int* info) {
  std::copy_n(ikeep, *n + 2, iw);
  iw[*n + 2] = *nz;
  for (int k = 0; k < *nz; ++k) {
    iw[*n + 3 + k] = rows[k] - 1;
    iw[*n + 3 + *nz + k] = columns[k] - 1;
  }
  *front = 1;
  std::fill_n(info, 20, 0);
  const Factors f(*n, a, iw);
  std::fill_n(f.blocks, f.band.size(), 0.0);
  eliminate_slacks(f);
  for (int i = 0; i < *n; ++i) {
    if (f.place[i] >= 0) continue;
    if (f.pivot[i] == 0) info[0] = -5;
    if (f.pivot[i] < 0) ++info[14];
  }
  if (info[0] != 0) return;
  eliminate_rows(f);
  if (!factor_band(f)) ++info[14];  // of the wrong inertia: Ipopt regularizes and comes again
}

void solve(int* n, double* a, int*, int* iw, int*, double*, int*, double* rhs, int*, int*, int*,
           double*) {
  const Factors f(*n, a, iw);
  VectorXd x = VectorXd::Zero(f.band.blocks() * f.band.width);
  auto for_pairs = [&](int of, const auto& use) {  // (unknown of that class, other, value)
    for (int k = 0; k < f.entries.count; ++k) {
      const int i = f.entries.row(k), j = f.entries.column(k);
      if (i == j) continue;
      if (f.place[i] == of)
        use(i, j, f.values[k]);
      else if (f.place[j] == of)
        use(j, i, f.values[k]);
    }
  };
  for_pairs(kSlack, [&](int i, int j, double v) { rhs[j] -= v * rhs[i] / f.pivot[i]; });
  for (int i = 0; i < *n; ++i)
    if (f.place[i] >= 0) x[f.place[i]] = rhs[i];
  for_pairs(kRow, [&](int i, int j, double v) {
    if (f.place[j] >= 0) x[f.place[j]] -= v * rhs[i] / f.pivot[i];
  });
  solve_band(f, x);
  for_pairs(kRow, [&](int i, int j, double v) {
    if (f.place[j] >= 0) rhs[i] -= v * x[f.place[j]];
  });
  for (int i = 0; i < *n; ++i) {
    if (f.place[i] >= 0) rhs[i] = x[f.place[i]];
    if (f.place[i] == kRow) rhs[i] /= f.pivot[i];
  }
  for_pairs(kSlack, [&](int i, int j, double v) { rhs[i] -= v * rhs[j]; });
  for (int i = 0; i < *n; ++i)
    if (f.place[i] == kSlack) rhs[i] /= f.pivot[i];
}

void set_defaults(int*, double*) {}

}  // namespace

void register_condensed_solver() {
  [[maybe_unused]] static const bool done = [] {
    LSL_setMA27(analyse, factor, solve, set_defaults);
    return true;
  }();
}

}  // namespace ayumi
