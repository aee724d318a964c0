// Eigen's results have the same bits on every processor: CMakeLists.txt sets the options for this.
// The expected sums are those of x86-64 with SSE2 and of ARM64; another version of Eigen may have
// other sums.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <bit>
#include <cstdint>

#include "ayumi/math/random.hpp"

namespace ayumi {
namespace {

using Eigen::MatrixXd;

MatrixXd random_matrix(Random& random, int rows, int columns) {
  MatrixXd matrix(rows, columns);
  for (int j = 0; j < columns; ++j)
    for (int i = 0; i < rows; ++i) matrix(i, j) = 2 * random.uniform() - 1;
  return matrix;
}

// Small matrices are solved coefficient by coefficient, larger ones in blocks of registers, and the
// largest in blocks of the cache.
std::uint64_t sum_of_bits(int size) {
  Random random(7);
  const MatrixXd a = random_matrix(random, size, size), b = random_matrix(random, size, size);
  const MatrixXd column = b.col(0);
  const MatrixXd positive = a * a.transpose() + MatrixXd::Identity(size, size);
  std::uint64_t sum = 0;
  for (const MatrixXd& result :
       {MatrixXd(a * b), MatrixXd(a.transpose() * column), MatrixXd(positive.llt().solve(b)),
        MatrixXd(a.partialPivLu().solve(b)), MatrixXd(a.householderQr().solve(column)),
        MatrixXd(a.inverse())})
    for (const double value : result.reshaped()) {
      sum = (sum ^ std::bit_cast<std::uint64_t>(value)) * 1099511628211u;
      sum ^= sum >> 29;
    }
  return sum;
}

TEST(EigenBits, AreThoseOfEveryProcessor) {
  EXPECT_EQ(sum_of_bits(6), 0x6137f2b5fc7bcb5bu);
  EXPECT_EQ(sum_of_bits(7), 0xbdef62e59cfdf5e3u);
  EXPECT_EQ(sum_of_bits(19), 0xc0d678c49ae7ccd8u);
  EXPECT_EQ(sum_of_bits(41), 0x7f7581dd128f98c8u);
  EXPECT_EQ(sum_of_bits(90), 0xa923c536a5c29337u);
  EXPECT_EQ(sum_of_bits(300), 0x45799e7ef7dd96c4u);
}

}  // namespace
}  // namespace ayumi
