#include "ayumi/dynamics/kernels/tree_kernels.hpp"

namespace {
typedef double Wide __attribute__((vector_size(16)));
}
#include "ayumi/dynamics/kernels/tree_kernels_body.hpp"

namespace ayumi::kernels {

const Kernels& plain_kernels() {
  static constexpr Kernels kernels = {"plain",
                                      2,
                                      inverse_dynamics<double>,
                                      forward_dynamics<double>,
                                      inverse_dynamics<Wide>,
                                      forward_dynamics<Wide>,
                                      sines_and_cosines,
                                      body_positions,
                                      body_velocities,
                                      mass_entries,
                                      newton_euler,
                                      factor_rows,
                                      solve_path,
                                      gram,
                                      multiply_add,
                                      solve_positive,
                                      contact_lines};
  return kernels;
}

}  // namespace ayumi::kernels
