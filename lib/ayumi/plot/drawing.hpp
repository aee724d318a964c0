#pragma once
// A flat drawing of lines, areas and text, and its two forms: SVG with text, and a picture.

#include <Eigen/Core>
#include <string>
#include <variant>
#include <vector>

#include "ayumi/render/image.hpp"

namespace ayumi {

/// A polyline or polygon, with x to the right and y down [pixel]. Colours are sRGB and alpha; with
/// alpha 0, nothing is drawn.
struct DrawnPath {
  std::vector<Eigen::Vector2d> points = {};
  bool closed = false;
  Eigen::Vector4f stroke = {0, 0, 0, 1};
  Eigen::Vector4f fill = {0, 0, 0, 0};
  double width = 1;  ///< width of the stroke [pixel]
  /// Lengths of dashes and gaps in turn [pixel]; if empty, the line is solid.
  std::vector<double> dashes = {};
};

/// A rectangle between two corners, filled and without a stroke.
DrawnPath filled_box(const Eigen::Vector2d& corner, const Eigen::Vector2d& opposite,
                     const Eigen::Vector4f& color);

struct DrawnText {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< anchor on the base line [pixel]
  std::string text;
  double size = 12;  ///< font size [pixel]
  TextAnchor anchor = TextAnchor::left;
  bool bold = false;
  bool upwards = false;  ///< the text is turned so that it reads from below
  Eigen::Vector4f color = {0.1f, 0.1f, 0.12f, 1};
};

struct Drawing {
  double width = 800, height = 600;  ///< size of the drawing [pixel]
  std::string title, description;    ///< texts for screen readers
  /// Items in the order in which they are drawn.
  std::vector<std::variant<DrawnPath, DrawnText>> items;
};

/// The text for use between tags or in quotes of SVG and HTML. Control characters except line ends
/// are left out.
std::string escaped(const std::string& text);

/// The width of a text in the font of drawings [pixel].
double text_width(const std::string& text, double size, bool bold = false);

/// The bytes of an SVG file on a white ground.
std::string to_svg(const Drawing& drawing);

/// The drawing as a picture, with `scale` picture pixels per pixel of the drawing.
Image to_image(const Drawing& drawing, double scale = 1);

/// Writes .svg or .png, depending on the name. Throws Error(usage) for another extension, and
/// Error(bad_file) if writing fails.
void write_drawing(const std::filesystem::path& path, const Drawing& drawing, double png_scale);

}  // namespace ayumi
