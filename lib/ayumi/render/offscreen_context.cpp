#include "ayumi/render/offscreen_context.hpp"

#include <algorithm>

#include "ayumi/base/error.hpp"
#include "ayumi/render/shader_cache.hpp"

namespace ayumi {

namespace {

constexpr bool kHasOsmesa =
#ifdef AYUMI_OSMESA
    true;
#else
    false;
#endif
constexpr bool kHasEgl =
#ifdef AYUMI_HAS_EGL
    true;
#else
    false;
#endif

}  // namespace

std::vector<Offscreen> offscreen_ways() {
  std::vector<Offscreen> ways;
  if (kHasOsmesa) ways.push_back(Offscreen::osmesa);
  if (kHasEgl) ways.push_back(Offscreen::egl);
  return ways;
}

OffscreenContext::OffscreenContext(Offscreen way) : way_(way) {
  const std::vector<Offscreen> ways = offscreen_ways();
  if (way == Offscreen::automatic && !ways.empty()) way_ = ways.front();
  if (std::find(ways.begin(), ways.end(), way_) == ways.end())
    fail(ErrorCode::internal, "off-screen rendering: this program was built without " +
                                  std::string(way == Offscreen::osmesa ? "OSMesa"
                                              : way == Offscreen::egl  ? "EGL"
                                                                       : "OSMesa and without EGL"));
  disable_shader_cache_on_full_disk();
  context_ =
      way_ == Offscreen::osmesa ? offscreen::Osmesa::create() : offscreen::Egl::create(display_);
  make_current();
}

OffscreenContext::~OffscreenContext() {
  if (way_ == Offscreen::osmesa)
    offscreen::Osmesa::destroy(context_);
  else
    offscreen::Egl::destroy(display_, context_);
}

void OffscreenContext::make_current() {
  const bool done = way_ == Offscreen::osmesa ? offscreen::Osmesa::make_current(context_, buffer_)
                                              : offscreen::Egl::make_current(display_, context_);
  if (!done) fail(ErrorCode::internal, "off-screen rendering: the context cannot be made current");
}

OffscreenContext::Function OffscreenContext::function(const char* name) const {
  const Function address = way_ == Offscreen::osmesa ? offscreen::Osmesa::function(name)
                                                     : offscreen::Egl::function(name);
  if (!address)
    fail(ErrorCode::internal, std::string("off-screen rendering: OpenGL lacks ") + name);
  return address;
}

}  // namespace ayumi
