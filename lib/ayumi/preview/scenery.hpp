#pragma once
// What stands on the ground plane: blocks, fields of heights, patches of another friction.

#include "ayumi/pattern/scenario.hpp"
#include "ayumi/preview/triangles.hpp"

namespace ayumi {

/// In the world frame; empty on a bare plane. Patches lie a fraction of a millimetre above it,
/// darker the less they hold.
Triangles make_scenery(const World& world);

}  // namespace ayumi
