#pragma once
// Pictures in the form that video encoders take.

#include <cstdint>
#include <vector>

#include "ayumi/render/image.hpp"

namespace ayumi {

/// Y, then Cb, then Cr by BT.709 in the range of video (16 to 235, 16 to 240). Cb and Cr have half
/// the resolution in both directions: each value is the mean of four pixels. Width and height must
/// be even.
void to_yuv420(const Image& image, std::vector<std::uint8_t>& planes);

}  // namespace ayumi
