// With a point P = O + u U + v V of the plane, clip coordinates are linear in (u, v, 1). The
// inverse of that map takes a pixel to (u, v, 1) / w, which is linear in the pixel. Therefore every
// edge of the visible part of the plane is a straight line of the picture, and in a row of pixels
// the plane lies between two ends.
#include "ayumi/render/ground_picture.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstring>

namespace ayumi {
namespace {

using Eigen::Vector3d;

// Distance at which the ground becomes the horizon, in distances of the camera from its target.
constexpr double kFade = 4.5;
constexpr float kShadowStrength = 0.42f;
constexpr std::array<float, 3> kHorizonColor = {0.877f, 0.893f, 0.907f};
constexpr std::array<float, 3> kZenithColor = {0.735f, 0.798f, 0.867f};
constexpr std::array<float, 3> kGroundColor = {0.798f, 0.801f, 0.798f};
constexpr std::array<float, 3> kFineColor = {0.646f, 0.653f, 0.659f};
constexpr std::array<float, 3> kBoldColor = {0.508f, 0.518f, 0.535f};
constexpr std::array<float, 3> kShadowColor = {0.03f, 0.04f, 0.07f};

/// Spacing and width of the lines of the grid [m], and the strength of their colour.
struct GridLines {
  float spacing, width, share;
};
constexpr GridLines kFine = {0.1f, 0.0022f, 0.55f}, kBold = {1.0f, 0.006f, 0.80f};

std::uint8_t to_byte(float share) { return static_cast<std::uint8_t>(share * 255 + 0.5f); }

typedef float Eight __attribute__((vector_size(32)));
typedef std::int32_t EightWhole __attribute__((vector_size(32)));

/// A row of pixels on the plane: numerators of u and v and the denominator at the first pixel,
/// their changes per pixel, and their changes per row.
struct GroundRow {
  std::array<float, 3> first, along, down;
  std::array<float, 2> middle;
  float fade;
};

#define AYUMI_INLINE [[gnu::always_inline]] inline

AYUMI_INLINE void larger(const Eight& a, const Eight& b, Eight& out) { out = a > b ? a : b; }
AYUMI_INLINE void within_one(Eight& x) {
  x = x > 0.0f ? x : x * 0.0f;
  x = x < 1.0f ? x : x * 0.0f + 1.0f;
}
AYUMI_INLINE void magnitude(const Eight& a, Eight& out) { out = a < 0.0f ? -a : a; }

AYUMI_INLINE void floor_of(const Eight& p, Eight& whole) {
  whole = __builtin_convertvector(__builtin_convertvector(p, EightWhole), Eight);
  whole = whole > p ? whole - 1.0f : whole;
}

/// The distance of points from the nearest line [m].
AYUMI_INLINE void off_line(const Eight& p, const GridLines& lines, Eight& away) {
  const Eight q = p * (1.0f / lines.spacing) + 0.5f;
  Eight whole;
  floor_of(q, whole);
  magnitude(q - 0.5f - whole, away);
  away *= lines.spacing;
}

// The share of a pixel that lines across one axis cover. Far away, where lines merge, it is the
// mean share.
AYUMI_INLINE void add_lines(const Eight& p, const Eight& footprint, const Eight& sharpness,
                            const GridLines& lines, Eight& cover) {
  Eight away;
  off_line(p, lines, away);
  Eight wide = footprint;
  wide = wide < lines.width ? wide * 0.0f + lines.width : wide;
  Eight share = 0.5f + (0.5f * wide - away) * sharpness;
  within_one(share);
  Eight thin = lines.width * sharpness;
  thin = thin < 1.0f ? thin : thin * 0.0f + 1.0f;
  share *= thin;
  Eight far = footprint * (2.0f / lines.spacing) - 0.6f;
  within_one(far);
  share += (lines.width / lines.spacing - share) * far;
  larger(cover, share, cover);
}

/// The u or v of the plane at each pixel, and the width of a pixel there.
struct Seen {
  Eight place, wide;
};

AYUMI_INLINE void distance_of(const GroundRow& row, const Eight& at, Eight& far) {
  far = 1.0f / (row.first[2] + row.along[2] * at);
}

AYUMI_INLINE void see(const GroundRow& row, size_t axis, const Eight& at, const Eight& far,
                      Seen& seen) {
  seen.place = (row.first[axis] + row.along[axis] * at) * far;
  Eight across, down;
  magnitude((row.along[axis] - seen.place * row.along[2]) * far, across);
  magnitude((row.down[axis] - seen.place * row.down[2]) * far, down);
  larger(across + down, at * 0.0f + 1e-6f, seen.wide);
}

/// The share of the ground's colour at a distance. Far away, the ground becomes the horizon.
AYUMI_INLINE void near_share(const GroundRow& row, const Eight& u, const Eight& v, Eight& near) {
  const Eight du = (u - row.middle[0]) * row.fade, dv = (v - row.middle[1]) * row.fade;
  const Eight square = du * du + dv * dv;
  near = 1.0f / (1.0f + square * square);
}

/// Determines for eight stretches of the row, each from its first to its last pixel, whether a part
/// of one of these lines may be in the stretch. In all other stretches, add_lines() adds nothing.
/// Along a row of pixels, the plane's coordinates only grow or only fall, and so does the width of
/// a pixel there.
AYUMI_INLINE void has_lines(const Seen& from, const Seen& to, const GridLines& lines,
                            EightWhole& has) {
  Eight wide, low, high, first, last;
  larger(from.wide, to.wide, wide);
  Eight line = wide;
  line = line < lines.width ? line * 0.0f + lines.width : line;
  const Eight reach = 0.51f * (line + wide);
  larger(from.place, to.place, high);
  low = from.place + to.place - high;
  floor_of((low - reach) * (1.0f / lines.spacing), first);
  floor_of((high + reach) * (1.0f / lines.spacing), last);
  has = (first != last) | (wide > 0.29f * lines.spacing);
}

/// The colours of eight pixels as bytes of whole numbers, with red as the lowest byte.
AYUMI_INLINE void mix_colors(const Eight& fine, const Eight& bold, const Eight& near,
                             std::array<std::int32_t, 8>& pixels) {
  EightWhole packed = {};
  for (size_t c = 0; c < 3; ++c) {
    Eight color = kGroundColor[c] + (kFineColor[c] - kGroundColor[c]) * fine;
    color += (kBoldColor[c] - color) * bold;
    color = kHorizonColor[c] + (color - kHorizonColor[c]) * near;
    packed |= __builtin_convertvector(color * 255.0f + 0.5f, EightWhole) << int(8 * c);
  }
  std::memcpy(pixels.data(), &packed, sizeof packed);
}

/// The lines that may be in a stretch: those across u or v, and bold ones only beside fine ones.
constexpr std::array<int, 2> kFineThere = {1, 2}, kBoldThere = {4, 8};

AYUMI_INLINE void eight_colors(const GroundRow& row, int x, int lines, float near_there,
                               std::array<std::int32_t, 8>& pixels) {
  const Eight step = {0, 1, 2, 3, 4, 5, 6, 7};
  const Eight at = step + float(x);
  Eight far, fine = step * 0.0f, bold = fine;
  distance_of(row, at, far);
  for (size_t axis = 0; axis < 2; ++axis) {
    if (!(lines & (kFineThere[axis] | kBoldThere[axis]))) continue;
    Seen seen;
    see(row, axis, at, far, seen);
    const Eight sharp = 1.0f / seen.wide;
    add_lines(seen.place, seen.wide, sharp, kFine, fine);
    if (lines & kBoldThere[axis]) add_lines(seen.place, seen.wide, sharp, kBold, bold);
  }
  mix_colors(fine * kFine.share, bold * kBold.share, step * 0.0f + near_there, pixels);
}

AYUMI_INLINE void draw_plane_row(const GroundRow& row, int begin, int end, std::uint8_t* rgb) {
  const Eight step = {0, 8, 16, 24, 32, 40, 48, 56};
  for (int block = begin; block < end; block += 64) {
    // The first and the last pixels of eight blocks of eight pixels.
    const Eight first = step + float(block), last = step + (float(block) + 7.0f);
    Eight far_first, far_last;
    distance_of(row, first, far_first);
    distance_of(row, last, far_last);
    EightWhole lines = {}, has;
    std::array<Seen, 2> from, to;
    for (size_t axis = 0; axis < 2; ++axis) {
      see(row, axis, first, far_first, from[axis]);
      see(row, axis, last, far_last, to[axis]);
      has_lines(from[axis], to[axis], kFine, has);
      lines |= has & kFineThere[axis];
      has_lines(from[axis], to[axis], kBold, has);
      lines |= has & kBoldThere[axis];
    }
    // The contribution of the horizon changes by less than a step of colour within eight pixels.
    // The last of them may lie beyond the visible end of the plane, even behind the camera.
    Eight near, near_last;
    near_share(row, from[0].place, from[1].place, near);
    near_share(row, to[0].place, to[1].place, near_last);
    near = ((far_last > 0.0f) & (near_last >= 0.0f)) ? 0.5f * (near + near_last) : near;
    std::array<std::int32_t, 8> plain, there;
    std::array<float, 8> nears;
    mix_colors(step * 0.0f, step * 0.0f, near, plain);
    std::memcpy(there.data(), &lines, sizeof lines);
    std::memcpy(nears.data(), &near, sizeof near);
    for (size_t part = 0; part < 8; ++part) {
      const int x = block + 8 * int(part), count = std::min(8, end - x);
      if (count <= 0) break;
      std::array<std::int32_t, 8> pixels;
      if (there[part])
        eight_colors(row, x, there[part], nears[part], pixels);
      else
        pixels.fill(plain[part]);
      // Each store writes one byte too many, which the next one overwrites.
      std::uint8_t* out = rgb + 3 * size_t(x);
      for (int i = 0; i + 1 < count; ++i) std::memcpy(out + 3 * i, &pixels[size_t(i)], 4);
      std::memcpy(out + 3 * (count - 1), &pixels[size_t(count - 1)], 3);
    }
  }
}

void plane_row(const GroundRow& row, int begin, int end, std::uint8_t* rgb) {
  draw_plane_row(row, begin, end, rgb);
}
#ifdef __x86_64__
[[gnu::target("avx2")]] void plane_row_avx2(const GroundRow& row, int begin, int end,
                                            std::uint8_t* rgb) {
  draw_plane_row(row, begin, end, rgb);
}
const auto kPlaneRow = __builtin_cpu_supports("avx2") ? plane_row_avx2 : plane_row;
#else
const auto kPlaneRow = plane_row;
#endif

}  // namespace

Eigen::Vector2d middle_of_plane(const Camera& camera, const GroundRectangle& plane) {
  const Vector3d target = camera.target - plane.origin;
  return {plane.u.dot(target), plane.v.dot(target)};
}

float ShadowPicture::at(float along_u, float along_v) const {
  const auto place = [](float share, int& low, int& high, float& part) {
    const float p = std::clamp(share * kSize - 0.5f, 0.0f, float(kSize - 1));
    low = static_cast<int>(p);
    high = std::min(low + 1, kSize - 1);
    part = p - float(low);
  };
  int left, right, below, above;
  float to_right, up;
  place(along_u, left, right, to_right);
  place(along_v, below, above, up);
  const auto value = [&](int x, int y) { return float(cover[size_t(y) * kSize + size_t(x)]); };
  const float low = value(left, below) + (value(right, below) - value(left, below)) * to_right;
  const float high = value(left, above) + (value(right, above) - value(left, above)) * to_right;
  return (low + (high - low) * up) * (1.0f / 255);
}

GroundPicture::GroundPicture(const Camera& camera, const Eigen::Matrix4d& to_clip, int width,
                             int height, const GroundRectangle& plane,
                             const Eigen::AlignedBox2d& hole, bool shown)
    : width_(width), height_(height), plane_(plane) {
  horizon_ = horizon_height(camera, plane.normal, to_clip.cast<float>());
  const double distance = (camera.eye - camera.target).norm();
  middle_ = middle_of_plane(camera, plane);
  whole_ = {std::round(middle_.x()), std::round(middle_.y())};
  fade_ = kFade * distance;
  if (!shown || camera.parallel_height > 0 || plane.normal.dot(camera.eye - plane.origin) <= 0)
    return;
  // Coefficients of (u, v, 1), where u and v are relative to `whole_`.
  Eigen::Matrix<double, 4, 3> corner;
  corner << plane.u, plane.v, plane.origin + plane.u * whole_.x() + plane.v * whole_.y(), 0, 0, 1;
  const Eigen::Matrix<double, 4, 3> seen = to_clip * corner;
  Eigen::Matrix3d flat;
  flat << seen.row(0), seen.row(1), seen.row(3);
  bool can = false;
  Eigen::Matrix3d back;
  flat.computeInverseWithCheck(back, can, 1e-12);
  if (!can) return;  // the plane is seen from the side in this case
  Eigen::Matrix3d from_pixel;
  from_pixel << 2.0 / width, 0, -1, 0, -2.0 / height, 1, 0, 0, 1;
  place_ = back * from_pixel;
  const Line u = place_.row(0), v = place_.row(1), w = place_.row(2), one(0, 0, 1);
  const Line depth = seen.row(2) * place_;
  const Eigen::Vector2d center = middle_ - whole_;
  const double reach = kPlaneReach * distance;
  seen_ = {one - depth,
           one + depth,
           (center.x() + reach) * w - u,
           u - (center.x() - reach) * w,
           (center.y() + reach) * w - v,
           v - (center.y() - reach) * w};
  if (!hole.isEmpty()) {
    const Eigen::Vector2d low = hole.min() - whole_, high = hole.max() - whole_;
    hole_ = {high.x() * w - u, u - low.x() * w, high.y() * w - v, v - low.y() * w};
  }
  shown_ = true;
}

PixelSpan GroundPicture::span(const std::vector<Line>& lines, int y) const {
  double first = 0, end = width_;
  for (const Line& line : lines) {
    const double here =
        line.x() * 0.5 + line.y() * (y + 0.5) + line.z();  // values at the first pixel
    if (line.x() > 0)
      first = std::max(first, std::ceil(-here / line.x()));
    else if (line.x() < 0)
      end = std::min(end, std::floor(here / -line.x()) + 1);
    else if (here < 0)
      return {};
    if (!(first < end)) return {};
  }
  return {static_cast<int>(first), static_cast<int>(end)};
}

std::array<PixelSpan, 2> GroundPicture::plane_in_row(int y) const {
  if (!shown_) return {};
  const PixelSpan all = span(seen_, y);
  if (all.begin >= all.end || hole_.empty()) return {all, {}};
  const PixelSpan hole = span(hole_, y);
  if (hole.begin >= hole.end) return {all, {}};
  return {PixelSpan{all.begin, std::clamp(hole.begin, all.begin, all.end)},
          PixelSpan{std::clamp(hole.end, all.begin, all.end), all.end}};
}

void GroundPicture::draw(const ShadowPicture& shadow, Image& image) const {
  image.width = width_;
  image.height = height_;
  image.rgb.resize(size_t(3) * size_t(width_) * size_t(height_));
  GroundRow row;
  for (size_t k = 0; k < 3 && shown_; ++k) {
    row.along[k] = static_cast<float>(place_(Eigen::Index(k), 0));
    row.down[k] = static_cast<float>(place_(Eigen::Index(k), 1));
  }
  row.middle = {static_cast<float>(middle_.x() - whole_.x()),
                static_cast<float>(middle_.y() - whole_.y())};
  row.fade = static_cast<float>(1 / fade_);
  for (int y = 0; y < height_; ++y) {
    std::uint8_t* rgb = image.pixel(0, y);
    const std::array<PixelSpan, 2> plane = plane_in_row(y);
    const double up = 1 - 2 * (y + 0.5) / height_;
    const auto above = static_cast<float>(std::clamp(up - horizon_, 0.0, 1.0));
    std::array<std::uint8_t, 3> sky;
    for (size_t c = 0; c < 3; ++c)
      sky[c] = to_byte(kHorizonColor[c] + (kZenithColor[c] - kHorizonColor[c]) * above);
    const auto fill = [&](int begin, int end) {
      for (int x = begin; x < end; ++x) std::memcpy(rgb + 3 * x, sky.data(), 3);
    };
    fill(0, plane[0].begin);
    fill(plane[0].end, std::max(plane[0].end, plane[1].begin));
    fill(std::max(plane[0].end, plane[1].end), width_);
    if (!shown_) continue;
    for (size_t k = 0; k < 3; ++k)
      row.first[k] =
          static_cast<float>(place_.row(Eigen::Index(k)).dot(Eigen::Vector3d(0.5, y + 0.5, 1)));
    for (const PixelSpan& part : plane)
      if (part.begin < part.end) kPlaneRow(row, part.begin, part.end, rgb);
  }
  if (shown_ && !shadow.cover.empty()) draw_shadow(shadow, image);
}

void GroundPicture::draw_shadow(const ShadowPicture& shadow, Image& image) const {
  const Eigen::Vector4d dark = shadow.dark.cast<double>();
  const Eigen::Vector2d center = plane_.center - whole_;
  const Line u = place_.row(0), v = place_.row(1), w = place_.row(2);
  const auto at = [&](int axis, double share) { return center[axis] + plane_.reach * share; };
  std::vector<Line> lines = {at(0, dark[0] + dark[2]) * w - u, u - at(0, dark[0] - dark[2]) * w,
                             at(1, dark[1] + dark[3]) * w - v, v - at(1, dark[1] - dark[3]) * w};
  lines.insert(lines.end(), seen_.begin(), seen_.end());
  const double half = 0.5 / plane_.reach;
  for (int y = 0; y < height_; ++y) {
    const PixelSpan part = span(lines, y);
    if (part.begin >= part.end) continue;
    const std::array<PixelSpan, 2> plane = plane_in_row(y);
    const Eigen::Vector3d first = place_ * Eigen::Vector3d(0.5, y + 0.5, 1);
    for (int x = part.begin; x < part.end; ++x) {
      if (x >= plane[0].end && x < plane[1].begin) x = plane[1].begin;
      if (x >= part.end) break;
      const Eigen::Vector3d q = first + place_.col(0) * x;
      const auto cover = kShadowStrength *
                         shadow.at(static_cast<float>(0.5 + half * (q.x() / q.z() - center.x())),
                                   static_cast<float>(0.5 + half * (q.y() / q.z() - center.y())));
      std::uint8_t* rgb = image.pixel(x, y);
      for (size_t c = 0; c < 3; ++c)
        rgb[c] = static_cast<std::uint8_t>(float(rgb[c]) +
                                           (255 * kShadowColor[c] - float(rgb[c])) * cover + 0.5f);
    }
  }
}

void lay_pixels_over(const std::uint8_t* rgba, int stride, const PixelBox& box, Image& image) {
  for (int row = 0; row < box.height; ++row) {
    const std::uint8_t* from = rgba + size_t(4) * size_t(stride) * size_t(row);
    std::uint8_t* to = image.pixel(box.x, image.height - 1 - box.y - row);
    for (int x = 0; x < box.width; ++x, from += 4, to += 3) {
      if (from[3] == 0) continue;
      const int rest = 255 - from[3];
      for (size_t c = 0; c < 3; ++c)
        to[c] = static_cast<std::uint8_t>(std::min(255, from[c] + (to[c] * rest + 127) / 255));
    }
  }
}

}  // namespace ayumi
