// Writes "uncertainty" of a pattern file as text.
#include "ayumi/io/pattern/scenario_text.hpp"

namespace ayumi {

namespace {

void add_spread(const UncertainQuantity& q, bool angle, bool in_degrees, Members& members) {
  const Distribution& d = q.distribution;
  const auto list = [&](const std::vector<double>& values) {
    Members items;
    for (const double value : values)
      items.item(angle ? angle_text(value, in_degrees) : number(value));
    return items.array();
  };
  switch (d.kind) {
    case Distribution::Kind::uniform:
      members.add("uniform", list({d.low, d.high}));
      break;
    case Distribution::Kind::normal:
      members.add("normal", list({d.mean, d.deviation}));
      break;
    case Distribution::Kind::truncated:
      members.add("truncated", list({d.mean, d.deviation, d.low, d.high}));
      break;
    case Distribution::Kind::choice:
      members.add("choice", list(d.values));
      break;
  }
  Members weights;
  for (const double weight : d.weights) weights.item(number(weight));
  if (!weights.empty()) members.add("weights", weights.array());
}

void add_origin(const UncertainQuantity& q, Members& members) {
  if (!q.factor.empty())
    members.add("factor", quoted(q.factor)).add("correlation", number(q.correlation));
  members.add("source", quoted(q.source));
}

std::string quantity_text(const UncertainQuantity& q, bool in_degrees) {
  const UncertainKindInfo& kind = info(q.kind);
  Members members;
  members.add("what", quoted(kind.name)).add("name", quoted(q.name));
  if (!q.on.empty()) members.add("on", quoted(q.on));
  if (kind.axis) members.add("axis", quoted(std::string(1, static_cast<char>('x' + q.axis))));
  if (q.each) members.add("each", "true");
  if (q.point != std::array<double, 3>{})
    members.add("point", vector_text(Eigen::Vector3d(q.point[0], q.point[1], q.point[2])));
  add_spread(q, kind.angle, in_degrees, members);
  add_origin(q, members);
  return members.object();
}

/// The text of a part; a part without a source is a single number.
std::string part_text(const UncertainQuantity& q, bool angle, bool in_degrees) {
  if (q.source.empty())
    return angle ? angle_text(q.distribution.values[0], in_degrees)
                 : number(q.distribution.values[0]);
  Members members;
  add_spread(q, angle, in_degrees, members);
  add_origin(q, members);
  return members.object();
}

std::string push_text(const UncertainPush& push, bool in_degrees) {
  Members members;
  members.add("name", quoted(push.name)).add("unit", quoted(push.bounds ? "B" : "N s"));
  members.add("size", part_text(push.size, false, in_degrees));
  members.add("direction", part_text(push.direction, true, in_degrees));
  members.add("time", push.phases ? quoted("phases") : part_text(push.time, false, in_degrees));
  if (push.link.source.empty()) {
    members.add("on", quoted(push.links.front()));
  } else {
    Members links, weights, on;
    for (const std::string& link : push.links) links.item(quoted(link));
    for (const double weight : push.link.distribution.weights) weights.item(number(weight));
    on.add("choice", links.array());
    if (!weights.empty()) on.add("weights", weights.array());
    add_origin(push.link, on);
    members.add("on", on.object());
  }
  members.add("duration", number(push.duration));
  return members.object();
}

}  // namespace

std::string uncertainty_text(const Uncertainty& uncertainty, bool in_degrees) {
  Members factors, quantities, pushes, members;
  for (const UncertainFactor& factor : uncertainty.factors)
    factors.item(
        Members().add("name", quoted(factor.name)).add("source", quoted(factor.source)).object());
  for (const UncertainQuantity& q : uncertainty.quantities)
    quantities.item(quantity_text(q, in_degrees));
  for (const UncertainPush& push : uncertainty.pushes) pushes.item(push_text(push, in_degrees));
  if (!factors.empty()) members.add("factors", factors.lines('[', ']', "    "));
  if (!quantities.empty()) members.add("quantities", quantities.lines('[', ']', "    "));
  if (!pushes.empty()) members.add("pushes", pushes.lines('[', ']', "    "));
  return members.lines('{', '}', "  ");
}

}  // namespace ayumi
