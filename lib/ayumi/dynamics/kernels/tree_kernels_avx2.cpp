// This source is compiled with -mavx2 if the compiler knows that option, and is empty otherwise. It
// uses no fused multiply-add, so that every instruction set gives the same bits.
#include "ayumi/dynamics/kernels/tree_kernels.hpp"

#ifdef __AVX2__

namespace {
typedef double Wide __attribute__((vector_size(32)));
}
#include "ayumi/dynamics/kernels/tree_kernels_body.hpp"

namespace ayumi::kernels {

const Kernels* avx2_kernels() {
  static constexpr Kernels kernels = {"AVX2",
                                      4,
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
  return &kernels;
}

}  // namespace ayumi::kernels

#else

namespace ayumi::kernels {
const Kernels* avx2_kernels() { return nullptr; }
}  // namespace ayumi::kernels

#endif
