#include "ayumi/preview/offscreen_context.hpp"

#include <GL/osmesa.h>

#include <string>

#include "ayumi/base/error.hpp"

namespace ayumi {

OffscreenContext::OffscreenContext() {
  const int attributes[] = {OSMESA_FORMAT,
                            OSMESA_RGBA,
                            OSMESA_DEPTH_BITS,
                            0,
                            OSMESA_PROFILE,
                            OSMESA_CORE_PROFILE,
                            OSMESA_CONTEXT_MAJOR_VERSION,
                            3,
                            OSMESA_CONTEXT_MINOR_VERSION,
                            3,
                            0};
  context_ = OSMesaCreateContextAttribs(attributes, nullptr);
  if (!context_)
    fail(ErrorCode::internal,
         "off-screen rendering: this OSMesa library gives no OpenGL 3.3 core context");
  make_current();
}

OffscreenContext::~OffscreenContext() {
  if (OSMesaGetCurrentContext() == context_) OSMesaMakeCurrent(nullptr, nullptr, 0, 0, 0);
  OSMesaDestroyContext(static_cast<OSMesaContext>(context_));
}

void OffscreenContext::make_current() {
  if (OSMesaGetCurrentContext() == context_) return;
  if (!OSMesaMakeCurrent(static_cast<OSMesaContext>(context_), buffer_, GL_UNSIGNED_BYTE, 16, 16))
    fail(ErrorCode::internal, "off-screen rendering: the OSMesa context cannot be made current");
}

void (*OffscreenContext::function(const char* name))() {
  const OSMESAproc address = OSMesaGetProcAddress(name);
  if (!address)
    fail(ErrorCode::internal, std::string("off-screen rendering: OpenGL lacks ") + name);
  return reinterpret_cast<void (*)()>(address);
}

}  // namespace ayumi
