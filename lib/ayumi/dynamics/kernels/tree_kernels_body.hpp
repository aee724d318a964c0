// Inverse and forward dynamics in link axes about the link's origin, for a scalar T that holds one
// or several states. Each instruction set has one source that includes this file and defines Wide.
// The file has no include guard and no external names. E is the rotation of the joint frame in its
// parent, P the rotation of the joint itself, r the joint's origin in the parent, s the joint's
// axis, q its coordinate, m the mass of a body, h its first moment and I its inertia about its
// origin, and a the classical acceleration of the origin (with gravity added). With
//   W = [alpha x] + w w' - |w|^2,
// the passes are:
//   outwards:  w = (E P)' w_p + s dq,   alpha = (E P)' alpha_p + s ddq + w x s dq,
//              a = (E P)' (a_p + W_p r)                    (sliding: r + s q, + s ddq + 2 w x s dq)
//   of a body: f = m a + W h,   n = h x a + I alpha + w x I w
//   inwards:   tau = s.n (sliding s.f),  f_p += E P f,  n_p += E P n + r x (E P f)
// Forward: the articulated bodies' inertia and bias force (p_f, p_n), with which
//   f = M a + H alpha + p_f,  n = H' a + I alpha + p_n,
// are carried inwards. At each joint, its acceleration is eliminated: with
//   U = (H s, I s),  D = s.I s + rotor,
//   (M H; H' I) -= U U' / D.

#include "ayumi/dynamics/kernels/tree_kernels_fours.hpp"
#include "ayumi/dynamics/kernels/tree_kernels_vectors.hpp"
// The kernels themselves, which use the definitions above.
#include "ayumi/dynamics/kernels/tree_kernels_factor.hpp"
#include "ayumi/dynamics/kernels/tree_kernels_forward.hpp"
#include "ayumi/dynamics/kernels/tree_kernels_inverse.hpp"
#include "ayumi/dynamics/kernels/tree_kernels_world.hpp"
