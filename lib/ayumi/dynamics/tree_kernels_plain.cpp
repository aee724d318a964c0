#include "ayumi/dynamics/tree_kernels.hpp"

namespace {
typedef double Wide __attribute__((vector_size(16)));
}
#include "ayumi/dynamics/tree_kernels_body.hpp"

namespace ayumi::kernels {

const Kernels& plain_kernels() {
  static constexpr Kernels kernels = {"plain",
                                      2,
                                      inverse_dynamics<double>,
                                      forward_dynamics<double>,
                                      mass_matrix<double>,
                                      inverse_dynamics<Wide>,
                                      forward_dynamics<Wide>,
                                      sines_and_cosines};
  return kernels;
}

}  // namespace ayumi::kernels
