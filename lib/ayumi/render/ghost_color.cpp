#include "ayumi/render/ghost_color.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>

#include "ayumi/render/renderer.hpp"
#include "ayumi/render/texture.hpp"

namespace ayumi {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

/// Hues of ghosts. Chosen: they are 38 to 98 degrees apart and stand out against a light and a dark
/// ground. Of hues that are equally far from the robot's, the first one is taken.
const std::array<Vector3f, 6> kHues = {{{0.93f, 0.45f, 0.05f},    // orange
                                        {0.16f, 0.62f, 0.20f},    // green
                                        {0.12f, 0.42f, 0.92f},    // blue
                                        {0.86f, 0.16f, 0.62f},    // magenta
                                        {0.05f, 0.62f, 0.62f},    // turquoise
                                        {0.50f, 0.27f, 0.88f}}};  // violet

/// Exponent of the weight with which a colour of the robot counts as the use of a hue; the weight
/// is 1 for the same hue. Chosen: at a distance of 47 degrees, the weight is one half. With 2, this
/// distance would be 66 degrees, and no hue would be left for a robot of three colours; with 8, it
/// would be 33 degrees, less than the distance of two hues that have the same name.
constexpr int kSharpness = 4;

/// Saturation below which a colour counts as grey. Chosen: silver has 0.05, and covers of a pale
/// colour have 0.17 and more.
constexpr float kGrey = 0.1f;

/// Share of the robot's surface for which the colours of heat are counted. Chosen: the share that
/// the bodies of a few joints near their limits have. With more, the robot's own colours would
/// count for little.
constexpr double kHeatShare = 0.2;

/// The colour as seen along the axis of greys: its direction is the hue, and its length the
/// saturation.
Vector2f chroma(const Vector3f& c) {
  return {c[0] - (c[1] + c[2]) / 2, std::sqrt(0.75f) * (c[1] - c[2])};
}

/// The part of each hue that the robot already uses.
struct Use {
  std::array<double, kHues.size()> by_hue = {};
  double area = 0;

  /// Colours are weighted by the square of the saturation, so that large pale covers do not hide a
  /// few bright ones.
  void add(const Vector3f& color, double weight) {
    const Vector2f own = chroma(color);
    const double saturation = own.norm();
    if (saturation < kGrey) return;
    for (size_t i = 0; i < kHues.size(); ++i) {
      const double near = (1 + chroma(kHues[i]).normalized().dot(own) / saturation) / 2;
      by_hue[i] += weight * saturation * saturation * std::pow(near, kSharpness);
    }
  }

  Vector3f rarest_hue() const {
    const auto least = std::min_element(by_hue.begin(), by_hue.end());
    return kHues[static_cast<size_t>(least - by_hue.begin())];
  }
};

/// The colour at a place in a picture, which is repeated beyond its edges.
Vector3f color_at(const Texture& picture, const Vector2f& uv) {
  const auto place = [](float share, int size) {
    const double within = double(share) - std::floor(double(share));
    return std::clamp(static_cast<int>(within * size), 0, size - 1);
  };
  const auto row = static_cast<size_t>(place(uv.y(), picture.height));
  const auto column = static_cast<size_t>(place(uv.x(), picture.width));
  const std::uint8_t* const pixel =
      &picture.rgba[4 * (row * static_cast<size_t>(picture.width) + column)];
  return Vector3f(pixel[0], pixel[1], pixel[2]) / 255;
}

void add(Use& use, const Triangles& surface, const Texture* picture) {
  for (size_t i = 0; i + 2 < surface.indices.size(); i += 3) {
    const RenderVertex& a = surface.vertices[surface.indices[i]];
    const RenderVertex& b = surface.vertices[surface.indices[i + 1]];
    const RenderVertex& c = surface.vertices[surface.indices[i + 2]];
    const double area = (b.position - a.position).cross(c.position - a.position).norm() / 2;
    if (!std::isfinite(area)) continue;
    use.area += area;
    const Vector2f middle = (a.uv + b.uv + c.uv) / 3;
    if (picture && middle.allFinite())
      use.add(color_at(*picture, middle), area);
    else
      use.add(Vector3f(a.color[0], a.color[1], a.color[2]) / 255, area);
  }
}

}  // namespace

GhostColors ghost_colors(const std::vector<BodySurface>& robot) {
  Use use;
  std::map<std::string, Texture> pictures;
  std::vector<std::string> notes;
  for (const BodySurface& body : robot) {
    add(use, body.closed, nullptr);
    add(use, body.open, nullptr);
    for (const TexturedSurface& part : body.textured) {
      const auto [picture, fresh] = pictures.try_emplace(part.texture);
      if (fresh) picture->second = read_texture(part.texture, notes);
      add(use, part.triangles, &picture->second);
    }
  }
  GhostColors colors;
  colors.beside_robot = use.rarest_hue();
  for (const float heat : {0.0f, 1.0f})
    use.add(heat_color(heat).head<3>(), kHeatShare / 2 * use.area);
  colors.beside_heat = use.rarest_hue();
  return colors;
}

std::string hex_text(const Vector3f& srgb) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string text = "#";
  for (const float part : srgb) {
    const long byte = std::lround(255 * std::clamp(part, 0.0f, 1.0f));
    text += {kDigits[byte / 16], kDigits[byte % 16]};
  }
  return text;
}

}  // namespace ayumi
