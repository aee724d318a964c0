#pragma once
// The OpenGL functions that the renderer uses, which are found at run time, and the OpenGL objects
// that it makes.

#include <GL/glcorearb.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ayumi/render/offscreen_context.hpp"
#include "ayumi/render/triangles.hpp"

namespace ayumi {

// clang-format off
#define AYUMI_GL_FUNCTIONS(X) \
  X(ACTIVETEXTURE, ActiveTexture) \
  X(ATTACHSHADER, AttachShader) \
  X(BINDBUFFER, BindBuffer) \
  X(BINDFRAMEBUFFER, BindFramebuffer) \
  X(BINDRENDERBUFFER, BindRenderbuffer) \
  X(BINDTEXTURE, BindTexture) \
  X(BINDVERTEXARRAY, BindVertexArray) \
  X(BLENDFUNCSEPARATE, BlendFuncSeparate) \
  X(BUFFERDATA, BufferData) \
  X(CHECKFRAMEBUFFERSTATUS, CheckFramebufferStatus) \
  X(CLEAR, Clear) \
  X(CLEARCOLOR, ClearColor) \
  X(COLORMASK, ColorMask) \
  X(COMPILESHADER, CompileShader) \
  X(CREATEPROGRAM, CreateProgram) \
  X(CREATESHADER, CreateShader) \
  X(DELETEFRAMEBUFFERS, DeleteFramebuffers) \
  X(DELETERENDERBUFFERS, DeleteRenderbuffers) \
  X(DELETESHADER, DeleteShader) \
  X(DELETETEXTURES, DeleteTextures) \
  X(DEPTHFUNC, DepthFunc) \
  X(DEPTHMASK, DepthMask) \
  X(DISABLE, Disable) \
  X(DRAWARRAYS, DrawArrays) \
  X(DRAWELEMENTS, DrawElements) \
  X(ENABLE, Enable) \
  X(ENABLEVERTEXATTRIBARRAY, EnableVertexAttribArray) \
  X(FRAMEBUFFERRENDERBUFFER, FramebufferRenderbuffer) \
  X(FRAMEBUFFERTEXTURE2D, FramebufferTexture2D) \
  X(GENBUFFERS, GenBuffers) \
  X(GENERATEMIPMAP, GenerateMipmap) \
  X(GENFRAMEBUFFERS, GenFramebuffers) \
  X(GENRENDERBUFFERS, GenRenderbuffers) \
  X(GENTEXTURES, GenTextures) \
  X(GENVERTEXARRAYS, GenVertexArrays) \
  X(GETPROGRAMINFOLOG, GetProgramInfoLog) \
  X(GETPROGRAMIV, GetProgramiv) \
  X(GETUNIFORMLOCATION, GetUniformLocation) \
  X(LINKPROGRAM, LinkProgram) \
  X(PIXELSTOREI, PixelStorei) \
  X(POLYGONOFFSET, PolygonOffset) \
  X(READPIXELS, ReadPixels) \
  X(RENDERBUFFERSTORAGEMULTISAMPLE, RenderbufferStorageMultisample) \
  X(SCISSOR, Scissor) \
  X(SHADERSOURCE, ShaderSource) \
  X(TEXIMAGE2D, TexImage2D) \
  X(TEXIMAGE2DMULTISAMPLE, TexImage2DMultisample) \
  X(TEXPARAMETERI, TexParameteri) \
  X(UNIFORM1F, Uniform1f) \
  X(UNIFORM2F, Uniform2f) \
  X(UNIFORM3F, Uniform3f) \
  X(UNIFORM4F, Uniform4f) \
  X(UNIFORMMATRIX4FV, UniformMatrix4fv) \
  X(USEPROGRAM, UseProgram) \
  X(VERTEXATTRIBPOINTER, VertexAttribPointer) \
  X(VIEWPORT, Viewport)
// clang-format on

/// Vertices in the layout of RenderVertex.
struct GlMesh {
  GLuint array = 0, vertices = 0, indices = 0;
};

/// A target to draw into.
struct GlTarget {
  GLuint framebuffer = 0, color = 0, depth = 0;
  int width = 0, height = 0;
  bool sampled = false;  ///< `color` is a texture of several samples per pixel
};

/// The functions need a current OffscreenContext, whose destruction frees all objects made here.
struct Gl {
#define AYUMI_GL_MEMBER(TYPE, name) PFNGL##TYPE##PROC name;
  AYUMI_GL_FUNCTIONS(AYUMI_GL_MEMBER)
#undef AYUMI_GL_MEMBER

  /// Throws Error(internal) with the name of a function that is missing.
  explicit Gl(const OffscreenContext& context);

  /// `between` is put before the text of the fragment shader. Throws Error(internal) with the
  /// message of the compiler if it fails.
  GLuint link(const char* vertex, const char* fragment, const char* between = "") const;
  /// A picture for surfaces, which is repeated beyond its edges.
  GLuint make_texture(const std::vector<std::uint8_t>& rgba, int width, int height) const;
  GlMesh make_mesh() const;
  /// A strip of two triangles over -1..1, which has only positions.
  GlMesh make_square() const;
  void fill(const GlMesh& mesh, const Triangles& triangles, GLenum usage) const;
  /// A mesh that has only positions, two numbers each.
  GlMesh make_places() const;
  /// A target with `samples` per pixel; 0 for a target that needs no resolving. Throws
  /// Error(internal) if OpenGL refuses.
  GlTarget make_target(int width, int height, int samples, GLenum format, bool depth) const;
  void discard(GlTarget& target) const;
  void draw(const IndexRange& range) const;

  void set(GLuint program, const char* name, const Eigen::Matrix4f& value) const;
  void set(GLuint program, const char* name, const Eigen::Vector3d& value) const;
  void set(GLuint program, const char* name, const Eigen::Vector4f& value) const;
  void set(GLuint program, const char* name, double x, double y) const;
  void set(GLuint program, const char* name, double value) const;
};

}  // namespace ayumi
