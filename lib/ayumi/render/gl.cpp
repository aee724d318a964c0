#include "ayumi/render/gl.hpp"

#include <array>
#include <string>

#include "ayumi/base/error.hpp"
#include "ayumi/render/offscreen_context.hpp"
#include "ayumi/render/shaders.hpp"

namespace ayumi {
namespace {

GLuint compile(const Gl& gl, GLenum kind, const char* between, const char* source) {
  const GLuint shader = gl.CreateShader(kind);
  const char* sources[] = {shaders::kCommon, between, source};
  gl.ShaderSource(shader, 3, sources, nullptr);
  gl.CompileShader(shader);
  return shader;
}

}  // namespace

Gl::Gl(const OffscreenContext& context) {
#define AYUMI_GL_LOAD(TYPE, name) \
  name = reinterpret_cast<PFNGL##TYPE##PROC>(context.function("gl" #name));
  AYUMI_GL_FUNCTIONS(AYUMI_GL_LOAD)
#undef AYUMI_GL_LOAD
}

GLuint Gl::link(const char* vertex, const char* fragment, const char* between) const {
  const GLuint program = CreateProgram();
  for (const GLuint shader : {compile(*this, GL_VERTEX_SHADER, "", vertex),
                              compile(*this, GL_FRAGMENT_SHADER, between, fragment)}) {
    AttachShader(program, shader);
    DeleteShader(shader);
  }
  LinkProgram(program);
  GLint linked = GL_FALSE;
  GetProgramiv(program, GL_LINK_STATUS, &linked);
  if (linked) return program;
  std::array<char, 1024> log{};
  GetProgramInfoLog(program, static_cast<GLsizei>(log.size()), nullptr, log.data());
  fail(ErrorCode::internal, std::string("off-screen rendering: a shader failed: ") + log.data());
}

GlMesh Gl::make_mesh() const {
  GlMesh mesh;
  GenVertexArrays(1, &mesh.array);
  BindVertexArray(mesh.array);
  GenBuffers(1, &mesh.vertices);
  GenBuffers(1, &mesh.indices);
  BindBuffer(GL_ARRAY_BUFFER, mesh.vertices);
  BindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh.indices);
  const auto attribute = [&](GLuint index, GLint size, GLenum type, size_t offset) {
    EnableVertexAttribArray(index);
    VertexAttribPointer(index, size, type, type == GL_UNSIGNED_BYTE, sizeof(RenderVertex),
                        reinterpret_cast<const void*>(offset));
  };
  attribute(0, 3, GL_FLOAT, offsetof(RenderVertex, position));
  attribute(1, 3, GL_FLOAT, offsetof(RenderVertex, normal));
  attribute(2, 4, GL_UNSIGNED_BYTE, offsetof(RenderVertex, color));
  attribute(3, 2, GL_FLOAT, offsetof(RenderVertex, uv));
  return mesh;
}

GlMesh Gl::make_places() const {
  GlMesh places;
  GenVertexArrays(1, &places.array);
  BindVertexArray(places.array);
  GenBuffers(1, &places.vertices);
  BindBuffer(GL_ARRAY_BUFFER, places.vertices);
  EnableVertexAttribArray(0);
  VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
  return places;
}

GlMesh Gl::make_square() const {
  const GlMesh square = make_places();
  const float corners[] = {-1, -1, 1, -1, -1, 1, 1, 1};
  BufferData(GL_ARRAY_BUFFER, sizeof corners, corners, GL_STATIC_DRAW);
  return square;
}

GLuint Gl::make_texture(const std::vector<std::uint8_t>& rgba, int width, int height) const {
  GLuint texture = 0;
  GenTextures(1, &texture);
  BindTexture(GL_TEXTURE_2D, texture);
  TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  GenerateMipmap(GL_TEXTURE_2D);
  TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  return texture;
}

void Gl::fill(const GlMesh& mesh, const Triangles& triangles, GLenum usage) const {
  BindVertexArray(mesh.array);
  BindBuffer(GL_ARRAY_BUFFER, mesh.vertices);
  BufferData(GL_ARRAY_BUFFER,
             static_cast<GLsizeiptr>(triangles.vertices.size() * sizeof(RenderVertex)),
             triangles.vertices.data(), usage);
  BufferData(GL_ELEMENT_ARRAY_BUFFER,
             static_cast<GLsizeiptr>(triangles.indices.size() * sizeof(std::uint32_t)),
             triangles.indices.data(), usage);
}

GlTarget Gl::make_target(int width, int height, int samples, GLenum format, bool depth) const {
  GlTarget target;
  target.width = width;
  target.height = height;
  GenFramebuffers(1, &target.framebuffer);
  BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
  const auto attach = [&](GLuint& name, GLenum storage, GLenum where) {
    GenRenderbuffers(1, &name);
    BindRenderbuffer(GL_RENDERBUFFER, name);
    RenderbufferStorageMultisample(GL_RENDERBUFFER, samples, storage, width, height);
    FramebufferRenderbuffer(GL_FRAMEBUFFER, where, GL_RENDERBUFFER, name);
  };
  if (samples > 0) {
    target.sampled = true;
    GenTextures(1, &target.color);
    BindTexture(GL_TEXTURE_2D_MULTISAMPLE, target.color);
    TexImage2DMultisample(GL_TEXTURE_2D_MULTISAMPLE, samples, format, width, height, GL_TRUE);
    FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D_MULTISAMPLE,
                         target.color, 0);
  } else {
    attach(target.color, format, GL_COLOR_ATTACHMENT0);
  }
  if (depth) attach(target.depth, GL_DEPTH_COMPONENT24, GL_DEPTH_ATTACHMENT);
  if (CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    fail(ErrorCode::internal, "off-screen rendering: no picture of " + std::to_string(width) +
                                  " x " + std::to_string(height) + " pixels could be made");
  return target;
}

void Gl::discard(GlTarget& target) const {
  if (target.framebuffer) DeleteFramebuffers(1, &target.framebuffer);
  if (target.depth) DeleteRenderbuffers(1, &target.depth);
  if (target.color && target.sampled) DeleteTextures(1, &target.color);
  if (target.color && !target.sampled) DeleteRenderbuffers(1, &target.color);
  target = {};
}

void Gl::set(GLuint program, const char* name, const Eigen::Matrix4f& value) const {
  UniformMatrix4fv(GetUniformLocation(program, name), 1, GL_FALSE, value.data());
}
void Gl::set(GLuint program, const char* name, const Eigen::Vector3d& value) const {
  const Eigen::Vector3f f = value.cast<float>();
  Uniform3f(GetUniformLocation(program, name), f[0], f[1], f[2]);
}
void Gl::set(GLuint program, const char* name, const Eigen::Vector4f& value) const {
  Uniform4f(GetUniformLocation(program, name), value[0], value[1], value[2], value[3]);
}
void Gl::set(GLuint program, const char* name, double x, double y) const {
  Uniform2f(GetUniformLocation(program, name), static_cast<float>(x), static_cast<float>(y));
}
void Gl::set(GLuint program, const char* name, double value) const {
  Uniform1f(GetUniformLocation(program, name), static_cast<float>(value));
}

void Gl::draw(const IndexRange& range) const {
  if (range.count > 0)
    DrawElements(GL_TRIANGLES, range.count, GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(range.first * sizeof(std::uint32_t)));
}

}  // namespace ayumi
