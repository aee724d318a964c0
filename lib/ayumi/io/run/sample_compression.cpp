#include "ayumi/io/run/sample_compression.hpp"

#include <zstd.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "ayumi/base/error.hpp"
#include "ayumi/io/compression.hpp"
#include "ayumi/math/linear_solve.hpp"

namespace ayumi {

namespace {

constexpr int kOrders = 5;   // Definition: number of orders, of which n is 0 to 4
constexpr int kRelated = 5;  // Definition: number for a column that is predicted from others

// The last four values of a column, the last one first; before the first value there are zeros.
using Past = std::array<double, 4>;

double prediction(int order, const Past& past) {
  const auto& [a, b, c, d] = past;
  double value = 0;
  if (order == 1) value = a;
  if (order == 2) value = 2 * a - b;
  if (order == 3) value = 3 * (a - b) + c;
  if (order == 4) value = 4 * (a + c) - 6 * b - d;
  return std::isfinite(value) ? value : 0;
}

void advance(Past& past, double value) { past = {value, past[0], past[1], past[2]}; }

// Floats have the same order as these integers, from the largest negative one to the largest
// positive one.
constexpr std::uint64_t kSign = std::uint64_t{1} << 63;
std::uint64_t rank_of(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  return (bits & kSign) != 0 ? ~bits : bits | kSign;
}
double value_at(std::uint64_t rank) {
  return std::bit_cast<double>((rank & kSign) != 0 ? rank & ~kSign : ~rank);
}

// The sign goes to the last bit, so that small differences of both signs are small numbers.
std::uint64_t folded(std::uint64_t difference) {
  return (difference << 1) ^ (0 - (difference >> 63));
}
std::uint64_t unfolded(std::uint64_t number) { return (number >> 1) ^ (0 - (number & 1)); }

double float_at(std::string_view bytes, size_t index) {
  double value = 0;
  std::memcpy(&value, bytes.data() + index * sizeof value, sizeof value);
  return value;
}

// The number of terms with a weight for each source: its value, its first and its second
// difference.
constexpr size_t kTerms = 3;  // Definition

struct Relation {
  std::vector<std::uint32_t> sources;
  std::vector<double> weights;  // kTerms weights for each source
};

using Column = std::vector<double>;

double before(const Column& column, size_t k, size_t rows) {
  return k >= rows ? column[k - rows] : 0;
}

std::array<double, kTerms> terms_at(const Column& source, size_t k) {
  const double a = source[k], b = before(source, k, 1), c = before(source, k, 2);
  return {a, a - b, (a - b) - (b - c)};
}

double prediction(const Relation& relation, const std::vector<Column>& columns, size_t k,
                  double last) {
  double value = last;
  for (size_t i = 0; i < relation.sources.size(); ++i) {
    const auto terms = terms_at(columns[relation.sources[i]], k);
    for (size_t n = 0; n < kTerms; ++n) value += relation.weights[kTerms * i + n] * terms[n];
  }
  return std::isfinite(value) ? value : 0;
}

// How the values of one column are predicted.
struct Predictor {
  int order = 0;  // kRelated: predicted by `relation`
  Relation relation;

  double next(const std::vector<Column>& columns, size_t k, const Past& past) const {
    return order == kRelated ? prediction(relation, columns, k, past[0]) : prediction(order, past);
  }
};

std::vector<std::uint64_t> residuals(const Predictor& predictor, const std::vector<Column>& columns,
                                     size_t c) {
  std::vector<std::uint64_t> numbers;
  numbers.reserve(columns[c].size());
  Past past = {};
  for (size_t k = 0; k < columns[c].size(); ++k) {
    const double value = columns[c][k];
    numbers.push_back(folded(rank_of(value) - rank_of(predictor.next(columns, k, past))));
    advance(past, value);
  }
  return numbers;
}

std::uint64_t bits_of(const std::vector<std::uint64_t>& numbers) {
  std::uint64_t bits = 0;
  for (const std::uint64_t number : numbers) bits += static_cast<unsigned>(std::bit_width(number));
  return bits;
}

// The weights with which the sources come nearest to the steps of the column. They are fitted by
// least squares over one out of every kFitRows rows. A relation holds to the last bits in most
// rows, and not at all where a motor is at its peak torque or where the law changes. So the worst
// rows are left out, and the rest is fitted again. Chosen: with twice as many rows in the fit, a
// log of the bundled walk has the same size.
constexpr size_t kFitRows = 7;
// Number of rounds of a fit. Chosen: 0.8 of the rows stay in each round, and half of them at the
// end.
constexpr int kFitRounds = 4;
// Share of rows that stay in a round. Chosen: together with kFitRounds.
constexpr double kFitShare = 0.8;
// Smallest number of rows for each weight. Chosen: weights of fewer rows would only reproduce them.
constexpr size_t kRowsPerWeight = 4;

Relation fitted_relation(const std::vector<Column>& columns, size_t c,
                         const std::vector<size_t>& sources) {
  Relation relation;
  relation.sources.assign(sources.begin(), sources.end());
  const size_t count = kTerms * sources.size();
  relation.weights.assign(count, 0);
  std::vector<size_t> rows;
  for (size_t k = 1; k < columns[c].size(); k += kFitRows) {
    bool finite = std::isfinite(columns[c][k]) && std::isfinite(columns[c][k - 1]);
    for (const size_t source : sources)
      for (const double term : terms_at(columns[source], k)) finite = finite && std::isfinite(term);
    if (finite) rows.push_back(k);
  }
  for (int round = 0; round < kFitRounds && rows.size() >= kRowsPerWeight * count; ++round) {
    Eigen::MatrixXd A(rows.size(), count);
    Eigen::VectorXd steps(rows.size());
    for (size_t r = 0; r < rows.size(); ++r) {
      const auto row = static_cast<Eigen::Index>(r);
      Eigen::Index at = 0;
      for (const size_t source : sources)
        for (const double term : terms_at(columns[source], rows[r])) A(row, at++) = term;
      steps[row] = columns[c][rows[r]] - columns[c][rows[r] - 1];
    }
    // The columns are scaled to one size, because the weights have units.
    Eigen::VectorXd size = A.colwise().norm().transpose();
    size = (size.array() > 0).select(size, 1);
    A = A * size.cwiseInverse().asDiagonal();
    const Eigen::VectorXd scaled = solve_least_squares(A, steps);
    const Eigen::VectorXd missed = (A * scaled - steps).cwiseAbs();
    for (size_t i = 0; i < count; ++i)
      relation.weights[i] =
          scaled[static_cast<Eigen::Index>(i)] / size[static_cast<Eigen::Index>(i)];
    std::vector<double> sorted(missed.begin(), missed.end());
    const auto limit = sorted.begin() +
                       static_cast<std::ptrdiff_t>(kFitShare * static_cast<double>(sorted.size()));
    std::nth_element(sorted.begin(), limit, sorted.end());
    std::vector<size_t> kept;
    for (size_t r = 0; r < rows.size(); ++r)
      if (missed[static_cast<Eigen::Index>(r)] <= *limit) kept.push_back(rows[r]);
    rows = std::move(kept);
  }
  return relation;
}

// The predictor with the shortest residuals, and these residuals.
Predictor best_predictor(const std::vector<Column>& columns, size_t c,
                         const std::vector<size_t>& sources, std::vector<std::uint64_t>& numbers) {
  Predictor best;
  numbers = residuals(best, columns, c);
  std::uint64_t least = bits_of(numbers);
  const auto consider = [&](Predictor other, std::uint64_t more) {
    std::vector<std::uint64_t> found = residuals(other, columns, c);
    const std::uint64_t bits = bits_of(found) + more;
    if (bits >= least) return;
    least = bits;
    best = std::move(other);
    numbers = std::move(found);
  };
  for (int order = 1; order < kOrders; ++order) consider({order, {}}, 0);
  if (!sources.empty())
    consider({kRelated, fitted_relation(columns, c, sources)},
             64 * kTerms * static_cast<std::uint64_t>(sources.size()));
  return best;
}

// The columns in an order in which each one comes after its sources. The list is shorter if some
// columns wait for each other.
std::vector<size_t> decoding_order(const std::vector<Predictor>& predictors) {
  std::vector<size_t> order;
  std::vector<char> known(predictors.size(), 0);
  for (bool found = true; found;) {
    found = false;
    for (size_t c = 0; c < predictors.size(); ++c) {
      const std::vector<std::uint32_t>& sources = predictors[c].relation.sources;
      const bool ready = std::all_of(sources.begin(), sources.end(),
                                     [&](std::uint32_t source) { return known[source] != 0; });
      if (known[c] != 0 || !ready) continue;
      known[c] = 1;
      order.push_back(c);
      found = true;
    }
  }
  return order;
}

template <class Number>
void append_number(std::string& bytes, Number number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

std::string head_of(const std::vector<Predictor>& predictors) {
  std::string head;
  for (const Predictor& predictor : predictors) head += static_cast<char>(predictor.order);
  for (const Predictor& predictor : predictors) {
    if (predictor.order != kRelated) continue;
    append_number(head, static_cast<std::uint32_t>(predictor.relation.sources.size()));
    for (const std::uint32_t source : predictor.relation.sources) append_number(head, source);
    for (const double weight : predictor.relation.weights) append_number(head, weight);
  }
  return head;
}

// Reads the text that head_of() wrote, and moves `at` to its end. Empty if it is not a head for
// `columns` columns.
std::vector<Predictor> predictors_of(const std::string& plain, size_t columns, size_t& at) {
  std::vector<Predictor> predictors(columns);
  bool good = plain.size() >= columns;
  at = 0;
  for (size_t c = 0; c < columns && good; ++c) {
    predictors[c].order = plain[at++];
    good = predictors[c].order >= 0 && predictors[c].order <= kRelated;
  }
  const auto read = [&](auto& number) {
    good = good && plain.size() - at >= sizeof number;
    if (!good) return;
    std::memcpy(&number, plain.data() + at, sizeof number);
    at += sizeof number;
  };
  for (Predictor& predictor : predictors) {
    if (!good) break;
    if (predictor.order != kRelated) continue;
    std::uint32_t count = 0;
    read(count);
    good = good && count <= columns;
    if (!good) break;
    predictor.relation.sources.resize(count);
    predictor.relation.weights.resize(kTerms * count);
    for (std::uint32_t& source : predictor.relation.sources) {
      read(source);
      good = good && source < columns;
    }
    for (double& weight : predictor.relation.weights) read(weight);
  }
  if (!good) predictors.clear();
  return predictors;
}

// The place after the head at which byte `plane` of the first value of a column stands (7 is the
// most significant byte).
size_t plane_begin(size_t plane, size_t column, size_t columns, size_t rows) {
  return ((7 - plane) * columns + column) * rows;
}

// Largest size of the text of head_of() [bytes]: every column is related to all others.
size_t largest_head(size_t columns) {
  return columns *
         (1 + sizeof(std::uint32_t) + columns * (sizeof(std::uint32_t) + kTerms * sizeof(double)));
}

}  // namespace

std::string compress_samples(std::string rows, size_t columns, const ColumnSources& sources) {
  const size_t count = columns == 0 ? 0 : rows.size() / (columns * sizeof(double));
  require(sources.empty() || sources.size() == columns,
          "the sources are for another number of columns");
  std::vector<Column> values(columns, Column(count));
  for (size_t c = 0; c < columns; ++c)
    for (size_t k = 0; k < count; ++k) values[c][k] = float_at(rows, k * columns + c);
  rows = {};
  // The head is as long as the predictors need, and stands directly before the planes.
  const size_t begin = largest_head(columns);
  std::string bytes(begin + columns * count * sizeof(double), '\0');
  std::vector<Predictor> predictors;
  std::vector<std::uint64_t> numbers;
  for (size_t c = 0; c < columns; ++c) {
    predictors.push_back(
        best_predictor(values, c, sources.empty() ? std::vector<size_t>() : sources[c], numbers));
    for (size_t plane = 0; plane < 8; ++plane)
      for (size_t k = 0; k < count; ++k)
        bytes[begin + plane_begin(plane, c, columns, count) + k] =
            static_cast<char>(numbers[k] >> (8 * plane));
  }
  require(decoding_order(predictors).size() == columns, "some columns predict each other");
  values = {};
  const std::string head = head_of(predictors);
  bytes.replace(begin - head.size(), head.size(), head);
  return zstd_frame(std::string_view(bytes).substr(begin - head.size()));
}

size_t largest_compressed_size(size_t columns, size_t rows) {
  return ZSTD_compressBound(largest_head(columns) + columns * rows * sizeof(double));
}

std::vector<std::string_view> sample_frames(std::string_view bytes, size_t count,
                                            const std::string& file) {
  std::vector<std::string_view> frames;
  for (size_t i = 0; i < count; ++i) {
    const size_t whole = ZSTD_findFrameCompressedSize(bytes.data(), bytes.size());
    if (ZSTD_isError(whole) != 0)
      fail(ErrorCode::bad_file, {file},
           "the file is truncated or damaged, because the samples (zstd) are incomplete");
    frames.push_back(bytes.substr(0, whole));
    bytes.remove_prefix(whole);
  }
  if (!bytes.empty())
    fail(ErrorCode::bad_file, {file},
         "the file is damaged: there are " + std::to_string(bytes.size()) +
             " bytes after the samples");
  return frames;
}

std::string decompress_samples(std::string_view bytes, size_t columns, size_t rows,
                               const std::string& file) {
  sample_frames(bytes, 1, file);
  const auto stop = [&](const std::string& what) {
    fail(ErrorCode::bad_file, {file}, "the file is damaged: " + what);
  };
  const std::string size =
      std::to_string(rows) + " rows of " + std::to_string(columns) + " columns";
  const size_t planes = columns * rows * sizeof(double);
  const unsigned long long announced = ZSTD_getFrameContentSize(bytes.data(), bytes.size());
  if (announced < columns + planes || announced > planes + largest_head(columns))
    stop("the samples are not " + size);
  std::string plain(announced, '\0');
  const size_t got = ZSTD_decompress(plain.data(), plain.size(), bytes.data(), bytes.size());
  if (got != plain.size())
    stop(std::string("the samples do not decompress (") + ZSTD_getErrorName(got) + ")");
  size_t head = 0;
  const std::vector<Predictor> predictors = predictors_of(plain, columns, head);
  const std::vector<size_t> order = decoding_order(predictors);
  if (order.size() != columns) stop("the description of the predicted columns is not valid");
  if (plain.size() != head + planes) stop("the samples are not " + size);
  std::vector<Column> values(columns, Column(rows));
  for (const size_t c : order) {
    Past past = {};
    for (size_t k = 0; k < rows; ++k) {
      std::uint64_t number = 0;
      for (size_t plane = 0; plane < 8; ++plane)
        number |= std::uint64_t{static_cast<unsigned char>(
                      plain[head + plane_begin(plane, c, columns, rows) + k])}
                  << (8 * plane);
      values[c][k] = value_at(unfolded(number) + rank_of(predictors[c].next(values, k, past)));
      advance(past, values[c][k]);
    }
  }
  std::string samples(planes, '\0');
  for (size_t c = 0; c < columns; ++c)
    for (size_t k = 0; k < rows; ++k)
      std::memcpy(samples.data() + (k * columns + c) * sizeof(double), &values[c][k],
                  sizeof(double));
  return samples;
}

}  // namespace ayumi
