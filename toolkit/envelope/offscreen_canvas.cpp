#include "taut/envelope/offscreen_canvas.h"

#include <GL/osmesa.h>
// Behind the header above: its types need those of GL.
#include <GL/glext.h>
#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include "taut/core/error.h"
#include "taut/envelope/envelope_shaders.h"

namespace taut {
namespace {

constexpr const char* library_name = TAUT_OSMESA_LIBRARY;

/// What is asked of the library itself, as dlsym() finds it.
struct Library {
  decltype(&OSMesaCreateContextAttribs) create = nullptr;
  decltype(&OSMesaMakeCurrent) make_current = nullptr;
  decltype(&OSMesaDestroyContext) destroy = nullptr;
  decltype(&OSMesaGetProcAddress) address = nullptr;
  std::string failure;  ///< empty if all of these are there
};

/// Loads the library, which stays until the program ends: its compiler keeps threads.
Library load_library() {
  Library library;
  void* handle = dlopen(library_name, RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) {
    const char* reason = dlerror();
    library.failure = reason != nullptr ? reason : library_name;
    return library;
  }
  const auto find = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::decay_t<decltype(function)>>(dlsym(handle, name));
    if (function == nullptr) library.failure = std::string(library_name) + " has no " + name;
  };
  find(library.create, "OSMesaCreateContextAttribs");
  find(library.make_current, "OSMesaMakeCurrent");
  find(library.destroy, "OSMesaDestroyContext");
  find(library.address, "OSMesaGetProcAddress");
  return library;
}

const Library& loaded_library() {
  static const Library library = load_library();
  return library;
}

[[noreturn]] void fail(const std::string& what) {
  throw BackendError("envelope images cannot be drawn: " + what);
}

/// The functions of OpenGL that are called; all of them through the
/// library, since those of another OpenGL in the same program would do nothing.
struct Functions {
  decltype(&glGetString) get_string = nullptr;
  decltype(&glGetIntegerv) get_integerv = nullptr;
  decltype(&glGetError) get_error = nullptr;
  decltype(&glViewport) viewport = nullptr;
  decltype(&glEnable) enable = nullptr;
  decltype(&glDisable) disable = nullptr;
  decltype(&glDepthFunc) depth_func = nullptr;
  decltype(&glDrawArrays) draw_arrays = nullptr;
  decltype(&glReadPixels) read_pixels = nullptr;
  decltype(&glReadBuffer) read_buffer = nullptr;
  decltype(&glPixelStorei) pixel_storei = nullptr;
  decltype(&glGenTextures) gen_textures = nullptr;
  decltype(&glBindTexture) bind_texture = nullptr;
  decltype(&glTexImage2D) tex_image2_d = nullptr;
  decltype(&glTexParameteri) tex_parameteri = nullptr;
  PFNGLACTIVETEXTUREPROC active_texture = nullptr;
  PFNGLCREATESHADERPROC create_shader = nullptr;
  PFNGLSHADERSOURCEPROC shader_source = nullptr;
  PFNGLCOMPILESHADERPROC compile_shader = nullptr;
  PFNGLGETSHADERIVPROC get_shaderiv = nullptr;
  PFNGLGETSHADERINFOLOGPROC get_shader_info_log = nullptr;
  PFNGLCREATEPROGRAMPROC create_program = nullptr;
  PFNGLATTACHSHADERPROC attach_shader = nullptr;
  PFNGLLINKPROGRAMPROC link_program = nullptr;
  PFNGLGETPROGRAMIVPROC get_programiv = nullptr;
  PFNGLGETPROGRAMINFOLOGPROC get_program_info_log = nullptr;
  PFNGLUSEPROGRAMPROC use_program = nullptr;
  PFNGLGETUNIFORMLOCATIONPROC get_uniform_location = nullptr;
  PFNGLUNIFORM1FPROC uniform1f = nullptr;
  PFNGLUNIFORM1IPROC uniform1i = nullptr;
  PFNGLGENVERTEXARRAYSPROC gen_vertex_arrays = nullptr;
  PFNGLBINDVERTEXARRAYPROC bind_vertex_array = nullptr;
  PFNGLDELETEVERTEXARRAYSPROC delete_vertex_arrays = nullptr;
  PFNGLGENBUFFERSPROC gen_buffers = nullptr;
  PFNGLBINDBUFFERPROC bind_buffer = nullptr;
  PFNGLBUFFERDATAPROC buffer_data = nullptr;
  PFNGLDELETEBUFFERSPROC delete_buffers = nullptr;
  PFNGLENABLEVERTEXATTRIBARRAYPROC enable_vertex_attrib_array = nullptr;
  PFNGLVERTEXATTRIBPOINTERPROC vertex_attrib_pointer = nullptr;
  PFNGLVERTEXATTRIBIPOINTERPROC vertex_attrib_i_pointer = nullptr;
  PFNGLGENFRAMEBUFFERSPROC gen_framebuffers = nullptr;
  PFNGLBINDFRAMEBUFFERPROC bind_framebuffer = nullptr;
  PFNGLFRAMEBUFFERTEXTURE2DPROC framebuffer_texture2_d = nullptr;
  PFNGLGENRENDERBUFFERSPROC gen_renderbuffers = nullptr;
  PFNGLBINDRENDERBUFFERPROC bind_renderbuffer = nullptr;
  PFNGLRENDERBUFFERSTORAGEPROC renderbuffer_storage = nullptr;
  PFNGLFRAMEBUFFERRENDERBUFFERPROC framebuffer_renderbuffer = nullptr;
  PFNGLCHECKFRAMEBUFFERSTATUSPROC check_framebuffer_status = nullptr;
  PFNGLCLEARBUFFERUIVPROC clear_bufferuiv = nullptr;
  PFNGLCLEARBUFFERFVPROC clear_bufferfv = nullptr;

  void load(const Library& library);
};

void Functions::load(const Library& library) {
  const auto find = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::decay_t<decltype(function)>>(library.address(name));
    if (function == nullptr) fail(std::string("the driver has no ") + name);
  };
  find(get_string, "glGetString");
  find(get_integerv, "glGetIntegerv");
  find(get_error, "glGetError");
  find(viewport, "glViewport");
  find(enable, "glEnable");
  find(disable, "glDisable");
  find(depth_func, "glDepthFunc");
  find(draw_arrays, "glDrawArrays");
  find(read_pixels, "glReadPixels");
  find(read_buffer, "glReadBuffer");
  find(pixel_storei, "glPixelStorei");
  find(gen_textures, "glGenTextures");
  find(bind_texture, "glBindTexture");
  find(tex_image2_d, "glTexImage2D");
  find(tex_parameteri, "glTexParameteri");
  find(active_texture, "glActiveTexture");
  find(create_shader, "glCreateShader");
  find(shader_source, "glShaderSource");
  find(compile_shader, "glCompileShader");
  find(get_shaderiv, "glGetShaderiv");
  find(get_shader_info_log, "glGetShaderInfoLog");
  find(create_program, "glCreateProgram");
  find(attach_shader, "glAttachShader");
  find(link_program, "glLinkProgram");
  find(get_programiv, "glGetProgramiv");
  find(get_program_info_log, "glGetProgramInfoLog");
  find(use_program, "glUseProgram");
  find(get_uniform_location, "glGetUniformLocation");
  find(uniform1f, "glUniform1f");
  find(uniform1i, "glUniform1i");
  find(gen_vertex_arrays, "glGenVertexArrays");
  find(bind_vertex_array, "glBindVertexArray");
  find(delete_vertex_arrays, "glDeleteVertexArrays");
  find(gen_buffers, "glGenBuffers");
  find(bind_buffer, "glBindBuffer");
  find(buffer_data, "glBufferData");
  find(delete_buffers, "glDeleteBuffers");
  find(enable_vertex_attrib_array, "glEnableVertexAttribArray");
  find(vertex_attrib_pointer, "glVertexAttribPointer");
  find(vertex_attrib_i_pointer, "glVertexAttribIPointer");
  find(gen_framebuffers, "glGenFramebuffers");
  find(bind_framebuffer, "glBindFramebuffer");
  find(framebuffer_texture2_d, "glFramebufferTexture2D");
  find(gen_renderbuffers, "glGenRenderbuffers");
  find(bind_renderbuffer, "glBindRenderbuffer");
  find(renderbuffer_storage, "glRenderbufferStorage");
  find(framebuffer_renderbuffer, "glFramebufferRenderbuffer");
  find(check_framebuffer_status, "glCheckFramebufferStatus");
  find(clear_bufferuiv, "glClearBufferuiv");
  find(clear_bufferfv, "glClearBufferfv");
}

}  // namespace

class OffscreenCanvas::Context {
 public:
  explicit Context(int size);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  void clear_triangles();
  void add(std::span<const Vertex> vertices);
  Layer draw(bool second);

  std::string driver;
  int pole = 1;
  double extent = 1;
  double reach = 1;

 private:
  struct Batch {
    GLuint array = 0;
    GLuint buffer = 0;
    GLsizei count = 0;
  };

  void start(int size);
  void check_driver();
  void make_program();
  GLuint shader(GLenum kind, const char* source) const;
  void make_attachments();
  GLuint integer_texture() const;
  GLuint framebuffer(GLuint names) const;
  void check(const char* what) const;

  const Library& library_;
  OSMesaContext context_ = nullptr;
  std::array<unsigned char, 4 * 16 * 16> unused_ = {};  // OSMesa wants a buffer of its own
  Functions gl_;
  int size_ = 0;
  GLuint program_ = 0;
  GLuint depth_ = 0;
  std::array<GLuint, 2> names_ = {};         // textures of the two layers
  std::array<GLuint, 2> framebuffers_ = {};  // and where they are drawn
  std::vector<Batch> batches_;
};

OffscreenCanvas::Context::Context(int size) : library_(loaded_library()) {
  if (!library_.failure.empty()) fail(library_.failure + "; install libosmesa6");
  try {
    start(size);
  } catch (...) {
    if (context_ != nullptr) library_.destroy(context_);
    throw;
  }
}

OffscreenCanvas::Context::~Context() { library_.destroy(context_); }

void OffscreenCanvas::Context::start(int size) {
  size_ = size;
  const std::array<int, 9> attributes = {OSMESA_FORMAT,
                                         OSMESA_RGBA,
                                         OSMESA_PROFILE,
                                         OSMESA_CORE_PROFILE,
                                         OSMESA_CONTEXT_MAJOR_VERSION,
                                         3,
                                         OSMESA_CONTEXT_MINOR_VERSION,
                                         3,
                                         0};
  context_ = library_.create(attributes.data(), nullptr);
  if (context_ == nullptr) fail("OSMesa gives no context of OpenGL 3.3");
  if (library_.make_current(context_, unused_.data(), GL_UNSIGNED_BYTE, 16, 16) != GL_TRUE) {
    fail("OSMesa does not make its context current");
  }
  gl_.load(library_);
  check_driver();
  make_program();
  make_attachments();
  gl_.viewport(0, 0, size_, size_);
  gl_.enable(GL_DEPTH_TEST);
  gl_.disable(GL_CULL_FACE);
  gl_.depth_func(GL_LESS);
  gl_.pixel_storei(GL_PACK_ALIGNMENT, 1);
  check("its set-up");
}

void OffscreenCanvas::Context::check_driver() {
  const auto text = [&](GLenum name) {
    const auto* value = reinterpret_cast<const char*>(gl_.get_string(name));
    if (value == nullptr) {
      fail("OSMesa does not answer; another OpenGL library may be loaded before it");
    }
    return std::string(value);
  };
  driver = text(GL_RENDERER) + ", OpenGL " + text(GL_VERSION);
  if (!driver.starts_with("llvmpipe") && !driver.starts_with("softpipe")) {
    fail("the driver is neither llvmpipe nor softpipe but " + driver);
  }
  GLint major = 0;
  GLint minor = 0;
  GLint largest = 0;
  gl_.get_integerv(GL_MAJOR_VERSION, &major);
  gl_.get_integerv(GL_MINOR_VERSION, &minor);
  if (10 * major + minor < 33) fail("OpenGL 3.3 is needed, not " + driver);
  gl_.get_integerv(GL_MAX_TEXTURE_SIZE, &largest);
  if (size_ < 1 || size_ > largest) {
    fail("the driver draws images of 1 to " + std::to_string(largest) + " pixels a side, not " +
         std::to_string(size_));
  }
}

GLuint OffscreenCanvas::Context::shader(GLenum kind, const char* source) const {
  const GLuint result = gl_.create_shader(kind);
  gl_.shader_source(result, 1, &source, nullptr);
  gl_.compile_shader(result);
  GLint done = GL_FALSE;
  gl_.get_shaderiv(result, GL_COMPILE_STATUS, &done);
  if (done == GL_TRUE) return result;
  std::array<char, 512> log = {};
  gl_.get_shader_info_log(result, GLsizei(log.size()), nullptr, log.data());
  fail(std::string("the driver does not take a shader: ") + log.data());
}

void OffscreenCanvas::Context::make_program() {
  program_ = gl_.create_program();
  gl_.attach_shader(program_, shader(GL_VERTEX_SHADER, vertex_shader));
  gl_.attach_shader(program_, shader(GL_FRAGMENT_SHADER, fragment_shader));
  gl_.link_program(program_);
  GLint done = GL_FALSE;
  gl_.get_programiv(program_, GL_LINK_STATUS, &done);
  if (done != GL_TRUE) {
    std::array<char, 512> log = {};
    gl_.get_program_info_log(program_, GLsizei(log.size()), nullptr, log.data());
    fail(std::string("the driver does not link its shaders: ") + log.data());
  }
  gl_.use_program(program_);
}

GLuint OffscreenCanvas::Context::integer_texture() const {
  GLuint texture = 0;
  gl_.gen_textures(1, &texture);
  gl_.bind_texture(GL_TEXTURE_2D, texture);
  gl_.tex_image2_d(GL_TEXTURE_2D, 0, GL_RG32UI, size_, size_, 0, GL_RG_INTEGER, GL_UNSIGNED_INT,
                   nullptr);
  gl_.tex_parameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl_.tex_parameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

GLuint OffscreenCanvas::Context::framebuffer(GLuint names) const {
  GLuint result = 0;
  gl_.gen_framebuffers(1, &result);
  gl_.bind_framebuffer(GL_FRAMEBUFFER, result);
  gl_.framebuffer_texture2_d(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, names, 0);
  gl_.framebuffer_renderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
  if (gl_.check_framebuffer_status(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    fail("the driver has no attachments of integers and depths of " + std::to_string(size_) +
         " pixels a side");
  }
  return result;
}

void OffscreenCanvas::Context::make_attachments() {
  gl_.active_texture(GL_TEXTURE0);
  gl_.gen_renderbuffers(1, &depth_);
  gl_.bind_renderbuffer(GL_RENDERBUFFER, depth_);
  gl_.renderbuffer_storage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, size_, size_);
  for (std::size_t k = 0; k < 2; ++k) {
    names_[k] = integer_texture();
    framebuffers_[k] = framebuffer(names_[k]);
  }
  gl_.bind_texture(GL_TEXTURE_2D, 0);
}

void OffscreenCanvas::Context::check(const char* what) const {
  const GLenum error = gl_.get_error();
  if (error == GL_NO_ERROR) return;
  if (error == GL_OUT_OF_MEMORY) throw LimitExceeded("envelope images: out of memory");
  fail(std::string("the driver reports error ") + std::to_string(error) + " after " + what);
}

void OffscreenCanvas::Context::clear_triangles() {
  for (const Batch& batch : batches_) {
    gl_.delete_vertex_arrays(1, &batch.array);
    gl_.delete_buffers(1, &batch.buffer);
  }
  batches_.clear();
}

void OffscreenCanvas::Context::add(std::span<const Vertex> vertices) {
  if (vertices.empty()) return;
  Batch batch;
  batch.count = GLsizei(vertices.size());
  gl_.gen_vertex_arrays(1, &batch.array);
  gl_.bind_vertex_array(batch.array);
  gl_.gen_buffers(1, &batch.buffer);
  gl_.bind_buffer(GL_ARRAY_BUFFER, batch.buffer);
  gl_.buffer_data(GL_ARRAY_BUFFER, GLsizeiptr(vertices.size_bytes()), vertices.data(),
                  GL_STATIC_DRAW);
  // The interface takes offsets into the buffer as pointers.
  const auto offset = [](std::size_t bytes) {
    return reinterpret_cast<const void*>(bytes);  // NOLINT(performance-no-int-to-ptr)
  };
  constexpr GLsizei stride = sizeof(Vertex);
  const auto floats = [&](GLuint location, GLint count, std::size_t at) {
    gl_.enable_vertex_attrib_array(location);
    gl_.vertex_attrib_pointer(location, count, GL_FLOAT, GL_FALSE, stride, offset(at));
  };
  floats(0, 2, offsetof(Vertex, x));
  floats(1, 3, offsetof(Vertex, point));
  floats(2, 2, offsetof(Vertex, b));
  floats(3, 3, offsetof(Vertex, bend));
  gl_.enable_vertex_attrib_array(4);
  gl_.vertex_attrib_i_pointer(4, 2, GL_UNSIGNED_INT, stride, offset(offsetof(Vertex, element)));
  batches_.push_back(batch);
  check("taking triangles");
}

OffscreenCanvas::Layer OffscreenCanvas::Context::draw(bool second) {
  gl_.bind_framebuffer(GL_FRAMEBUFFER, framebuffers_[second ? 1 : 0]);
  // No texture is bound while it is drawn to.
  gl_.bind_texture(GL_TEXTURE_2D, second ? names_[0] : 0);
  const auto at = [&](const char* name) { return gl_.get_uniform_location(program_, name); };
  gl_.uniform1f(at("size"), float(size_));
  gl_.uniform1f(at("pole"), float(pole));
  gl_.uniform1f(at("extent"), float(extent));
  gl_.uniform1f(at("reach"), float(reach));
  gl_.uniform1i(at("second"), second ? 1 : 0);
  gl_.uniform1i(at("first_names"), 0);
  const std::array<GLuint, 4> empty = {nothing, nothing, nothing, nothing};
  const GLfloat farthest = 1;
  gl_.clear_bufferuiv(GL_COLOR, 0, empty.data());
  gl_.clear_bufferfv(GL_DEPTH, 0, &farthest);
  for (const Batch& batch : batches_) {
    gl_.bind_vertex_array(batch.array);
    gl_.draw_arrays(GL_TRIANGLES, 0, batch.count);
  }
  const auto side = std::size_t(size_);
  Layer layer{std::vector<Pixel>(side * side), std::vector<float>(side * side)};
  gl_.read_buffer(GL_COLOR_ATTACHMENT0);
  gl_.read_pixels(0, 0, size_, size_, GL_RG_INTEGER, GL_UNSIGNED_INT, layer.pixels.data());
  gl_.read_pixels(0, 0, size_, size_, GL_DEPTH_COMPONENT, GL_FLOAT, layer.depths.data());
  check("drawing");
  // Rows of OpenGL begin at the bottom.
  for (std::size_t row = 0; row < side / 2; ++row) {
    const auto turn = [&](auto& rows) {
      const auto from = rows.begin() + std::ptrdiff_t(row * side);
      std::swap_ranges(from, from + std::ptrdiff_t(side),
                       rows.begin() + std::ptrdiff_t((side - 1 - row) * side));
    };
    turn(layer.pixels);
    turn(layer.depths);
  }
  return layer;
}

OffscreenCanvas::OffscreenCanvas(int size) : context_(std::make_unique<Context>(size)) {}
OffscreenCanvas::~OffscreenCanvas() = default;

const std::string& OffscreenCanvas::driver() const { return context_->driver; }

void OffscreenCanvas::begin(int pole, double extent, double reach) {
  context_->clear_triangles();
  context_->pole = pole;
  context_->extent = extent;
  context_->reach = reach;
}

void OffscreenCanvas::add(std::span<const Vertex> vertices) { context_->add(vertices); }
OffscreenCanvas::Layer OffscreenCanvas::draw_first() { return context_->draw(false); }
OffscreenCanvas::Layer OffscreenCanvas::draw_second() { return context_->draw(true); }

}  // namespace taut
