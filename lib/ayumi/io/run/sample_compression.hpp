#pragma once
// Rows of 64-bit floats, compressed without losing a bit. The values of a column are samples of a
// smooth quantity, so each is predicted from the ones before it by the polynomial of order n - 1
// through the last n of them:
//   n = 0: 0;  1: a;  2: 2a - b;  3: 3(a - b) + c;  4: 4(a + c) - 6b - d
// where a is the last value, b the one before, and so on.
// Some columns nearly follow from others in the same row: an angle from its rate, a torque from the
// angle and its target. If the caller names these sources s, the prediction may also be
//   a + sum of u s + v (s - s') + w (s - 2 s' + s'')
// with weights u, v, w by least squares, which are written too. Value and prediction are mapped to
// integers that have the same order by size as the floats. Their difference is a small integer. The
// bytes of the differences are written plane by plane, the most significant byte of all values
// first, and compressed by zstd. Each column has the prediction whose differences need the fewest
// bytes.

#include <string>
#include <string_view>
#include <vector>

namespace ayumi {

/// For each column, the columns from which it may be predicted; empty if there are none. No two
/// columns may follow from each other, directly or through others.
using ColumnSources = std::vector<std::vector<size_t>>;

/// `rows` holds rows of `columns` floats, one after the other. Move it into the call: the function
/// frees it early, and needs at most twice its memory.
std::string compress_samples(std::string rows, size_t columns, const ColumnSources& sources = {});

/// Largest size of what compress_samples() returns for this number of columns and rows.
size_t largest_compressed_size(size_t columns, size_t rows);

/// The `count` results of compress_samples() that stand one after the other in `bytes`. Throws
/// Error(bad_file), beginning with `file`, if they are truncated or damaged, or if there are more
/// or fewer. Each may still have another size than expected.
std::vector<std::string_view> sample_frames(std::string_view bytes, size_t count,
                                            const std::string& file);

/// Returns the rows. Throws Error(bad_file), beginning with `file`, if `bytes` is not the whole
/// result of compress_samples() for this number of columns and rows.
std::string decompress_samples(std::string_view bytes, size_t columns, size_t rows,
                               const std::string& file);

}  // namespace ayumi
