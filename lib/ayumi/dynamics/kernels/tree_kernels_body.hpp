// Inverse and forward dynamics in link axes about the link's origin, for a scalar T that holds one
// or several states; included by one source per instruction set, which names Wide. No guard, no
// external names. With E the joint frame's turn, P the joint's and r its origin in the parent,
// classical accelerations a (of the origin, gravity added) and W = [alpha x] + w w' - |w|^2:
//   outwards:  w = (E P)' w_p + s dq,   alpha = (E P)' alpha_p + s ddq + w x s dq,
//              a = (E P)' (a_p + W_p r)                    (sliding: r + s q, + s ddq + 2 w x s dq)
//   of a body: f = m a + W h,   n = h x a + I alpha + w x I w
//   inwards:   tau = s.n (sliding s.f),  f_p += E P f,  n_p += E P n + r x (E P f)
// Forward: the articulated f = M a + H alpha + p_f, n = H' a + I alpha + p_n go inwards with the
// joint solved out, U = (H s, I s), D = s.I s + rotor: (M H; H' I) -= U U' / D.

#include "ayumi/dynamics/kernels/tree_kernels_fours.hpp"
#include "ayumi/dynamics/kernels/tree_kernels_vectors.hpp"
// The kernels themselves, which use what stands above.
#include "ayumi/dynamics/kernels/tree_kernels_factor.hpp"
#include "ayumi/dynamics/kernels/tree_kernels_forward.hpp"
#include "ayumi/dynamics/kernels/tree_kernels_inverse.hpp"
#include "ayumi/dynamics/kernels/tree_kernels_world.hpp"
