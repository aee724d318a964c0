// The interface is that of the solver MA27, which Ipopt's loader takes from outside: analyse the
// pattern, factor, solve. All memory belongs to Ipopt: `ikeep` (3 n) is passed from analysis to
// factorization, `iw` and `a` from factorization to solution, and all stay unchanged from one
// factorization to the next, so that the solver itself has no state.
//   ikeep  class or place of every unknown [n], width of the band (negative once iw holds the
//          plan), number of places
//   iw     the same, number of nonzeros, then the plan: the target of every nonzero
//   a      values of the nonzeros, pivots [n], values of the rows by group, the band
// Rows with the same unknowns form a group, a dense matrix V: V' D V is added to the band, with D
// the inverse pivots. The band is stored by columns. The length of each column is the width plus
// the size of a panel, so that parts of the band are dense matrices whose columns are one less than
// this length apart; the entries of a panel beyond the width are zero and stay zero.
#include "ayumi/repair/nlp/banded_kkt_solver.hpp"

#include <coin/HSLLoader.h>
#include <dlfcn.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <mutex>
#include <numeric>
#include <utility>
#include <vector>

namespace ayumi {

namespace {

using Eigen::Index;
using Eigen::Map;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Definition: classes of unknowns that are eliminated separately. The others have a place >= 0 in
// the band.
constexpr int kSlack = -1;  // it has a single neighbour
constexpr int kRow = -2;    // its neighbours are slacks and places

// The kernels of the solve that runs on this thread. Definition.
thread_local const kernels::Kernels* kernels_in_use = &kernels::best_kernels();

struct Nonzeros {
  int count;
  const int *rows, *columns;
  int first;  // index of the first row
  int row(int k) const { return rows[k] - first; }
  int column(int k) const { return columns[k] - first; }
};

struct Band {
  // Number of columns that are factored at once. Chosen: it changes the time of a factorization,
  // but not its result.
  static constexpr int kPanel = 32;
  int width = 1, places = 0;  // farthest entry below the diagonal; number of columns in use
  int columns() const { return (places + kPanel - 1) / kPanel * kPanel; }
  int length() const { return width + kPanel; }  // length of a stored column
  Index size() const { return static_cast<Index>(columns()) * length(); }
};

// Multipliers are the last unknowns. If two neighbours both look like rows, the first is a variable
// and the second is a multiplier.
std::vector<int> classes(int n, const Nonzeros& entries) {
  constexpr int kNone = -1, kMany = -2;  // Definition
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

// Orders the places by the lowest unknown that each of them meets in a row. This is the order of
// time if the unknowns are in the order of time. Returns the band.
Band place(int n, const Nonzeros& entries, std::vector<int>& place) {
  place = classes(n, entries);
  std::vector<int> low(n);
  std::iota(low.begin(), low.end(), 0);
  for (int i = 0; i < n; ++i)
    if (place[i] == kRow) low[i] = n;
  // A row gets the lowest index of its unknowns; an unknown gets the lowest index of the unknowns
  // that it meets directly or, below, in a row.
  auto take_lower = [&](int i, int j) {
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

  // All places of a row meet when the row is eliminated. For an unknown in the band, only the
  // entries of its own column count.
  std::vector<int> first(n, n), last(n, -1);
  for_sides(entries, [&](int i, int j) {
    if (place[j] < 0 || place[i] == kSlack) return;
    if (place[i] >= 0) {
      band.width = std::max(band.width, std::abs(place[i] - place[j]));
      return;
    }
    first[i] = std::min(first[i], place[j]);
    last[i] = std::max(last[i], place[j]);
  });
  for (int i = 0; i < n; ++i)
    if (last[i] >= 0) band.width = std::max(band.width, last[i] - first[i]);
  return band;
}

// The target of every nonzero, as a sequence of integers:
struct Plan {
  std::vector<int> diagonal;  // pairs of an unknown and its nonzero
  std::vector<int> links;     // triples of a slack, its neighbour, and the nonzero
  std::vector<int> inner;     // triples of the lower place, the upper place, and the nonzero
  // For each group: numbers of rows and places, the rows, the places, and their nonzeros place by
  // place.
  std::vector<int> groups;
};

Plan plan(int n, const Nonzeros& entries, const int* place) {
  Plan result;
  std::vector<std::vector<std::pair<int, int>>> rows(n);  // pairs of a place and its nonzero
  for (int k = 0; k < entries.count; ++k) {
    const int i = entries.row(k), j = entries.column(k);
    if (i == j)
      result.diagonal.insert(result.diagonal.end(), {i, k});
    else if (place[i] == kSlack || place[j] == kSlack)
      result.links.insert(result.links.end(),
                          {place[i] == kSlack ? i : j, place[i] == kSlack ? j : i, k});
    else if (place[i] >= 0 && place[j] >= 0)
      result.inner.insert(result.inner.end(),
                          {std::max(place[i], place[j]), std::min(place[i], place[j]), k});
    else
      rows[place[i] == kRow ? i : j].emplace_back(place[place[i] == kRow ? j : i], k);
  }
  std::map<std::vector<int>, std::vector<int>> groups;  // rows by their places
  for (int i = 0; i < n; ++i) {
    if (rows[i].empty()) continue;
    std::sort(rows[i].begin(), rows[i].end());
    std::vector<int> places;
    for (const auto& entry : rows[i]) places.push_back(entry.first);
    groups[places].push_back(i);
  }
  for (const auto& [places, members] : groups) {
    auto& out = result.groups;
    out.insert(out.end(), {static_cast<int>(members.size()), static_cast<int>(places.size())});
    out.insert(out.end(), members.begin(), members.end());
    out.insert(out.end(), places.begin(), places.end());
    for (size_t p = 0; p < places.size(); ++p)
      for (const int i : members) out.push_back(rows[i][p].second);
  }
  return result;
}

// A part of the plan in Ipopt's memory: its length, then its integers.
struct Part {
  int count;
  const int* at;
  explicit Part(const int* begin) : count(*begin), at(begin + 1) {}
  const int* end() const { return at + count; }
};

// A group of rows that meet the same places.
struct Group {
  int rows, places;
  const int *row, *place, *nonzero;
  double* values;  // rows x places
  Map<MatrixXd> matrix() const { return {values, rows, places}; }
};

using Block = Map<MatrixXd, 0, Eigen::OuterStride<>>;

// Views into Ipopt's arrays for factor and solve.
struct Factors {
  int n;
  const int* place;
  Band band;
  Part diagonal, links, inner, groups;
  double *values, *pivot, *of_groups, *columns;

  Factors(int size, double* a, const int* iw)
      : n(size),
        place(iw),
        band{iw[n], iw[n + 1]},
        diagonal(iw + n + 3),
        links(diagonal.end()),
        inner(links.end()),
        groups(inner.end()),
        values(a),
        pivot(a + iw[n + 2]),
        of_groups(pivot + n),
        columns(of_groups + iw[n + 2]) {}

  double& at(int i, int j) const { return columns[i + static_cast<Index>(j) * stride()]; }
  Index stride() const { return band.length() - 1; }
  Block block(int i, int j, int rows, int width) const {
    return {&at(i, j), rows, width, Eigen::OuterStride<>(stride())};
  }

  template <class Use>
  void for_groups(const Use& use) const {
    double* next = of_groups;
    for (const int* g = groups.at; g != groups.end();) {
      const Group group{g[0], g[1], g + 2, g + 2 + g[0], g + 2 + g[0] + g[1], next};
      use(group);
      next += group.rows * group.places;
      g = group.nonzero + group.rows * group.places;
    }
  }
};

// Computes the pivots of slacks and rows, and adds the nonzeros between places to the band.
void eliminate_slacks(const Factors& f) {
  std::fill_n(f.pivot, f.n, 0.0);
  for (const int* e = f.diagonal.at; e != f.diagonal.end(); e += 2) f.pivot[e[0]] += f.values[e[1]];
  for (const int* e = f.inner.at; e != f.inner.end(); e += 3) f.at(e[0], e[1]) += f.values[e[2]];
  // Nonzero between a slack and its neighbour, which may come in parts.
  std::vector<double> link(f.n, 0.0);
  std::vector<int> neighbour(f.n, -1);
  for (const int* e = f.links.at; e != f.links.end(); e += 3) {
    link[e[0]] += f.values[e[2]];
    neighbour[e[0]] = e[1];
  }
  for (int i = 0; i < f.n; ++i)
    if (neighbour[i] >= 0) f.pivot[neighbour[i]] -= link[i] * link[i] / f.pivot[i];
  for (int i = 0; i < f.n; ++i)
    if (f.place[i] >= 0) f.at(f.place[i], f.place[i]) += f.pivot[i];
  for (int p = f.band.places; p < f.band.columns(); ++p) f.at(p, p) = 1;
}

// Lines of numbers for the kernels, each filled with zeros up to a multiple of four.
struct Lines {
  std::vector<double> numbers;
  int length = 0;

  void resize(int count, int entries) {
    length = (entries + 3) / 4 * 4;
    numbers.assign(static_cast<size_t>(count) * length, 0.0);
  }
  double* line(int i) { return numbers.data() + static_cast<Index>(i) * length; }
};

// Number of columns of a symmetric product that are computed at once. Chosen: they fit into the
// first cache.
constexpr int kTogether = 8;

// Calls use(j, column) for the columns j of the symmetric product of lines A and B; column[i - j]
// is its entry (i, j), i >= j.
template <class Use>
void for_product(const kernels::Kernels& kernels, Lines& A, Lines& B, int depth, int size,
                 std::vector<double>& scratch, const Use& use) {
  scratch.resize(static_cast<size_t>(kTogether) * A.length);
  for (int j = 0; j < size; j += kTogether) {
    const int columns = std::min(kTogether, size - j);
    kernels.gram(A.line(0) + j, A.length, B.line(0) + j, B.length, depth, size - j, columns,
                 scratch.data(), A.length);
    for (int k = 0; k < columns; ++k) use(j + k, scratch.data() + k * (A.length + 1));
  }
}

// A run of consecutive places.
struct Run {
  int first, end;  // indices among the places of the group
};

// Fills the runs of places. Returns false if a place appears twice.
bool find_runs(const Group& g, std::vector<Run>& runs) {
  runs.clear();
  bool once = true;
  for (int p = 0; p < g.places; ++p) {
    if (p > 0 && g.place[p] == g.place[p - 1] + 1) {
      ++runs.back().end;
      continue;
    }
    once = once && (p == 0 || g.place[p] != g.place[p - 1]);
    runs.push_back({p, p + 1});
  }
  return once;
}

// Adds -v v' / pivot of every row.
void eliminate_rows(const Factors& f) {
  const kernels::Kernels& kernels = *kernels_in_use;
  Lines lines, scaled;
  std::vector<double> scratch;
  std::vector<Run> runs;
  f.for_groups([&](const Group& g) {
    for (int k = 0; k < g.rows * g.places; ++k) g.values[k] = f.values[g.nonzero[k]];
    lines.resize(g.rows, g.places);
    scaled.resize(g.rows, g.places);
    for (int r = 0; r < g.rows; ++r) {
      const double factor = -1 / f.pivot[g.row[r]];
      double *line = lines.line(r), *other = scaled.line(r);
      for (int p = 0; p < g.places; ++p) {
        line[p] = g.values[r + static_cast<Index>(p) * g.rows];
        other[p] = factor * line[p];
      }
    }
    const bool once = find_runs(g, runs);
    const auto add = [&](int j, const double* sum) {
      double* column = &f.at(0, g.place[j]);
      if (!once) {
        column[g.place[j]] += sum[0];
        // Each of several nonzeros at one place counts in both orders.
        for (int i = j + 1; i < g.places; ++i)
          column[g.place[i]] += g.place[i] == g.place[j] ? 2 * sum[i - j] : sum[i - j];
        return;
      }
      for (const Run& run : runs) {
        const int first = std::max(run.first, j);
        if (first >= run.end) continue;
        double* to = column + g.place[first];
        const double* from = sum + (first - j);
        for (int i = 0; i < run.end - first; ++i) to[i] += from[i];
      }
    };
    for_product(kernels, lines, scaled, g.rows, g.places, scratch, add);
  });
}

// The factor of a panel's own block as a path whose rows are those of the block from the last to
// the first: the kernel then solves forwards.
struct PanelPath {
  static constexpr int kPanel = Band::kPanel;
  std::array<int, kPanel> parent, depth, offset;
  std::array<double, kPanel * kPanel> rows;
  std::array<double, kPanel> inverse;

  explicit PanelPath(const Block& own) {
    for (int k = 0; k < kPanel; ++k) {
      parent[k] = k - 1;
      depth[k] = k;
      offset[k] = k * kPanel;
      const int t = kPanel - 1 - k;
      inverse[k] = 1 / own(t, t);
      for (int s = 0; s < k; ++s) rows[k * kPanel + s] = own(kPanel - 1 - s, t);
    }
  }

  void solve(const kernels::Kernels& kernels, Lines& lines) const {
    kernels.solve_path({kPanel, parent.data(), depth.data(), offset.data()}, rows.data(),
                       inverse.data(), kPanel - 1, lines.length, lines.line(0));
  }
};

bool factor_band(const Factors& f) {
  const kernels::Kernels& kernels = *kernels_in_use;
  const int count = f.band.columns(), panel = Band::kPanel;
  Lines below;
  std::vector<double> scratch;
  for (int j = 0; j < count; j += panel) {
    Block own = f.block(j, j, panel, panel);
    Eigen::Ref<MatrixXd, 0, Eigen::OuterStride<>> in_place = own;
    if (Eigen::LLT<decltype(in_place)>(in_place).info() != Eigen::Success) return false;
    const int after = j + panel, rows = std::min(f.band.width, count - after);
    if (rows <= 0) continue;
    below.resize(panel, rows);
    for (int t = 0; t < panel; ++t)
      std::copy_n(&f.at(after, j + t), rows, below.line(panel - 1 - t));
    PanelPath(own).solve(kernels, below);
    for (int t = 0; t < panel; ++t)
      std::copy_n(below.line(panel - 1 - t), rows, &f.at(after, j + t));
    const auto subtract = [&](int k, const double* sum) {
      double* column = &f.at(after + k, after + k);
      for (int i = 0; i < rows - k; ++i) column[i] -= sum[i];
    };
    for_product(kernels, below, below, panel, rows, scratch, subtract);
  }
  return true;
}

void solve_band(const Factors& f, VectorXd& x) {
  const int count = f.band.columns(), panel = Band::kPanel;
  for (int j = 0; j < count; j += panel) {
    auto own = x.segment(j, panel);
    f.block(j, j, panel, panel).triangularView<Eigen::Lower>().solveInPlace(own);
    const int rows = std::min(f.band.width, count - j - panel);
    if (rows > 0) x.segment(j + panel, rows).noalias() -= f.block(j + panel, j, rows, panel) * own;
  }
  for (int j = count - panel; j >= 0; j -= panel) {
    auto own = x.segment(j, panel);
    const int rows = std::min(f.band.width, count - j - panel);
    if (rows > 0)
      own.noalias() -= f.block(j + panel, j, rows, panel).transpose() * x.segment(j + panel, rows);
    f.block(j, j, panel, panel).triangularView<Eigen::Lower>().transpose().solveInPlace(own);
  }
}

// ---- the interface. Entries of `info`: 0 is the outcome (0 good, -5 singular), 4 and 5 are the
// lengths of a and iw, and 14 is the number of negative pivots.

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
  info[4] = static_cast<int>(2 * *nz + *n + band.size());
  info[5] = 4 * (*n + *nz) + 8;
}

// Writes the plan into `iw`, once after the analysis.
void write_plan(int n, const Nonzeros& entries, int* ikeep, int* iw) {
  std::copy_n(ikeep, n + 2, iw);
  const Plan p = plan(n, entries, ikeep);
  iw[n + 2] = entries.count;
  int* out = iw + n + 3;
  for (const std::vector<int>* part : {&p.diagonal, &p.links, &p.inner, &p.groups}) {
    *out++ = static_cast<int>(part->size());
    out = std::copy(part->begin(), part->end(), out);
  }
  ikeep[n] = -ikeep[n];
}

void factor(int* n, int* nz, const int* rows, const int* columns, double* a, int*, int* iw, int*,
            int* ikeep, int*, int* front, int*, int*, double*, int* info) {
  if (ikeep[*n] > 0) write_plan(*n, {*nz, rows, columns, 1}, ikeep, iw);
  *front = 1;
  std::fill_n(info, 20, 0);
  const Factors f(*n, a, iw);
  std::fill_n(f.columns, f.band.size(), 0.0);
  eliminate_slacks(f);
  for (int i = 0; i < *n; ++i) {
    if (f.place[i] >= 0) continue;
    if (f.pivot[i] == 0) info[0] = -5;
    if (f.pivot[i] < 0) ++info[14];
  }
  if (info[0] != 0) return;
  eliminate_rows(f);
  if (!factor_band(f)) ++info[14];  // wrong inertia: Ipopt regularizes and factors again
}

void solve(int* n, double* a, int*, int* iw, int*, double*, int*, double* rhs, int*, int*, int*,
           double*) {
  const Factors f(*n, a, iw);
  VectorXd x = VectorXd::Zero(f.band.columns()), row, met;
  for (const int* e = f.links.at; e != f.links.end(); e += 3)
    rhs[e[1]] -= f.values[e[2]] * rhs[e[0]] / f.pivot[e[0]];
  for (int i = 0; i < *n; ++i) {
    if (f.place[i] >= 0) x[f.place[i]] = rhs[i];
    if (f.place[i] == kRow) rhs[i] /= f.pivot[i];
  }
  f.for_groups([&](const Group& g) {
    row.resize(g.rows);
    for (int r = 0; r < g.rows; ++r) row[r] = rhs[g.row[r]];
    met.noalias() = g.matrix().transpose() * row;
    for (int p = 0; p < g.places; ++p) x[g.place[p]] -= met[p];
  });
  solve_band(f, x);
  f.for_groups([&](const Group& g) {
    met.resize(g.places);
    for (int p = 0; p < g.places; ++p) met[p] = x[g.place[p]];
    row.noalias() = g.matrix() * met;
    for (int r = 0; r < g.rows; ++r) rhs[g.row[r]] -= row[r] / f.pivot[g.row[r]];
  });
  for (int i = 0; i < *n; ++i)
    if (f.place[i] >= 0) rhs[i] = x[f.place[i]];
  for (const int* e = f.links.at; e != f.links.end(); e += 3)
    rhs[e[0]] -= f.values[e[2]] * rhs[e[1]];
  for (int i = 0; i < *n; ++i)
    if (f.place[i] == kSlack) rhs[i] /= f.pivot[i];
}

void set_defaults(int*, double*) {}

// ---- the callers that are served. Ipopt has one place for MA27 in the whole process. While a
// solve of Ayumi runs, this place has the functions below: on a thread with such a solve, they lead
// to this solver; on any other thread, they lead to the HSL library that Ipopt itself would have
// loaded.

thread_local bool serves_this_thread = false;

constexpr int kNoOtherSolver = -99;  // Definition: INFO(1) without an HSL library; Ipopt gives up

/// The functions of MA27 in the HSL library; null without one. The library is loaded once and never
/// unloaded.
struct HslLibrary {
  ma27ad_t analyse = nullptr;
  ma27bd_t factor = nullptr;
  ma27cd_t solve = nullptr;
  ma27id_t set_defaults = nullptr;

  HslLibrary() {
    void* library = dlopen(LSL_HSLLibraryName(), RTLD_NOW | RTLD_LOCAL);
    if (!library) return;
    analyse = reinterpret_cast<ma27ad_t>(dlsym(library, "ma27ad_"));
    factor = reinterpret_cast<ma27bd_t>(dlsym(library, "ma27bd_"));
    solve = reinterpret_cast<ma27cd_t>(dlsym(library, "ma27cd_"));
    set_defaults = reinterpret_cast<ma27id_t>(dlsym(library, "ma27id_"));
  }
};

const HslLibrary& hsl() {
  static const HslLibrary library;
  return library;
}

void route_analyse(int* n, int* nz, const int* rows, const int* columns, int* iw, int* liw,
                   int* ikeep, int* iw1, int* steps, int* flag, int* icntl, double* cntl, int* info,
                   double* operations) {
  const auto routed = serves_this_thread ? analyse : hsl().analyse;
  if (routed)
    routed(n, nz, rows, columns, iw, liw, ikeep, iw1, steps, flag, icntl, cntl, info, operations);
  else
    info[0] = kNoOtherSolver;
}

void route_factor(int* n, int* nz, const int* rows, const int* columns, double* a, int* la, int* iw,
                  int* liw, int* ikeep, int* steps, int* front, int* iw1, int* icntl, double* cntl,
                  int* info) {
  const auto routed = serves_this_thread ? factor : hsl().factor;
  if (routed)
    routed(n, nz, rows, columns, a, la, iw, liw, ikeep, steps, front, iw1, icntl, cntl, info);
  else
    info[0] = kNoOtherSolver;
}

void route_solve(int* n, double* a, int* la, int* iw, int* liw, double* w, int* front, double* rhs,
                 int* iw1, int* steps, int* icntl, double* cntl) {
  const auto routed = serves_this_thread ? solve : hsl().solve;
  if (routed) routed(n, a, la, iw, liw, w, front, rhs, iw1, steps, icntl, cntl);
}

void route_set_defaults(int* icntl, double* cntl) {
  const auto routed = serves_this_thread ? set_defaults : hsl().set_defaults;
  if (routed) routed(icntl, cntl);
}

/// Number of solves that hold the place, over all threads.
struct Holders {
  std::mutex mutex;
  int count = 0;
};

Holders& holders() {
  static Holders all;
  return all;
}

// Returns false if the place belongs to the host program: its functions cannot be read back from
// Ipopt, so they could not be restored either.
bool hold_place() {
  Holders& all = holders();
  const std::scoped_lock lock(all.mutex);
  if (all.count == 0) {
    if (LSL_isMA27available()) return false;
    LSL_setMA27(route_analyse, route_factor, route_solve, route_set_defaults);
  }
  ++all.count;
  return true;
}

void leave_place() {
  Holders& all = holders();
  const std::scoped_lock lock(all.mutex);
  if (--all.count == 0) LSL_setMA27(nullptr, nullptr, nullptr, nullptr);
}

}  // namespace

BandedKktScope::BandedKktScope(bool wanted, const kernels::Kernels& kernels)
    : outer_(serves_this_thread), outer_kernels_(kernels_in_use), active_(wanted && hold_place()) {
  serves_this_thread = active_;
  kernels_in_use = &kernels;
}

BandedKktScope::~BandedKktScope() {
  if (active_) leave_place();
  serves_this_thread = outer_;
  kernels_in_use = outer_kernels_;
}

BandedKktPause::BandedKktPause() : outer_(serves_this_thread) { serves_this_thread = false; }
BandedKktPause::~BandedKktPause() { serves_this_thread = outer_; }

}  // namespace ayumi
