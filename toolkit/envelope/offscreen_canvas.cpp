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

/// The functions of OpenGL that are called, by their names without "gl"; all of them through the
/// library, since those of another OpenGL in the same program would do nothing.
struct Functions {
  decltype(&glGetString) GetString = nullptr;
  decltype(&glGetIntegerv) GetIntegerv = nullptr;
  decltype(&glGetError) GetError = nullptr;
  decltype(&glViewport) Viewport = nullptr;
  decltype(&glEnable) Enable = nullptr;
  decltype(&glDisable) Disable = nullptr;
  decltype(&glDepthFunc) DepthFunc = nullptr;
  decltype(&glDrawArrays) DrawArrays = nullptr;
  decltype(&glReadPixels) ReadPixels = nullptr;
  decltype(&glReadBuffer) ReadBuffer = nullptr;
  decltype(&glPixelStorei) PixelStorei = nullptr;
  decltype(&glGenTextures) GenTextures = nullptr;
  decltype(&glBindTexture) BindTexture = nullptr;
  decltype(&glTexImage2D) TexImage2D = nullptr;
  decltype(&glTexParameteri) TexParameteri = nullptr;
  PFNGLACTIVETEXTUREPROC ActiveTexture = nullptr;
  PFNGLCREATESHADERPROC CreateShader = nullptr;
  PFNGLSHADERSOURCEPROC ShaderSource = nullptr;
  PFNGLCOMPILESHADERPROC CompileShader = nullptr;
  PFNGLGETSHADERIVPROC GetShaderiv = nullptr;
  PFNGLGETSHADERINFOLOGPROC GetShaderInfoLog = nullptr;
  PFNGLCREATEPROGRAMPROC CreateProgram = nullptr;
  PFNGLATTACHSHADERPROC AttachShader = nullptr;
  PFNGLLINKPROGRAMPROC LinkProgram = nullptr;
  PFNGLGETPROGRAMIVPROC GetProgramiv = nullptr;
  PFNGLGETPROGRAMINFOLOGPROC GetProgramInfoLog = nullptr;
  PFNGLUSEPROGRAMPROC UseProgram = nullptr;
  PFNGLGETUNIFORMLOCATIONPROC GetUniformLocation = nullptr;
  PFNGLUNIFORM1FPROC Uniform1f = nullptr;
  PFNGLUNIFORM1IPROC Uniform1i = nullptr;
  PFNGLGENVERTEXARRAYSPROC GenVertexArrays = nullptr;
  PFNGLBINDVERTEXARRAYPROC BindVertexArray = nullptr;
  PFNGLDELETEVERTEXARRAYSPROC DeleteVertexArrays = nullptr;
  PFNGLGENBUFFERSPROC GenBuffers = nullptr;
  PFNGLBINDBUFFERPROC BindBuffer = nullptr;
  PFNGLBUFFERDATAPROC BufferData = nullptr;
  PFNGLDELETEBUFFERSPROC DeleteBuffers = nullptr;
  PFNGLENABLEVERTEXATTRIBARRAYPROC EnableVertexAttribArray = nullptr;
  PFNGLVERTEXATTRIBPOINTERPROC VertexAttribPointer = nullptr;
  PFNGLVERTEXATTRIBIPOINTERPROC VertexAttribIPointer = nullptr;
  PFNGLGENFRAMEBUFFERSPROC GenFramebuffers = nullptr;
  PFNGLBINDFRAMEBUFFERPROC BindFramebuffer = nullptr;
  PFNGLFRAMEBUFFERTEXTURE2DPROC FramebufferTexture2D = nullptr;
  PFNGLGENRENDERBUFFERSPROC GenRenderbuffers = nullptr;
  PFNGLBINDRENDERBUFFERPROC BindRenderbuffer = nullptr;
  PFNGLRENDERBUFFERSTORAGEPROC RenderbufferStorage = nullptr;
  PFNGLFRAMEBUFFERRENDERBUFFERPROC FramebufferRenderbuffer = nullptr;
  PFNGLCHECKFRAMEBUFFERSTATUSPROC CheckFramebufferStatus = nullptr;
  PFNGLCLEARBUFFERUIVPROC ClearBufferuiv = nullptr;
  PFNGLCLEARBUFFERFVPROC ClearBufferfv = nullptr;

  void load(const Library& library);
};

void Functions::load(const Library& library) {
  const auto find = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::decay_t<decltype(function)>>(library.address(name));
    if (function == nullptr) fail(std::string("the driver has no ") + name);
  };
  find(GetString, "glGetString");
  find(GetIntegerv, "glGetIntegerv");
  find(GetError, "glGetError");
  find(Viewport, "glViewport");
  find(Enable, "glEnable");
  find(Disable, "glDisable");
  find(DepthFunc, "glDepthFunc");
  find(DrawArrays, "glDrawArrays");
  find(ReadPixels, "glReadPixels");
  find(ReadBuffer, "glReadBuffer");
  find(PixelStorei, "glPixelStorei");
  find(GenTextures, "glGenTextures");
  find(BindTexture, "glBindTexture");
  find(TexImage2D, "glTexImage2D");
  find(TexParameteri, "glTexParameteri");
  find(ActiveTexture, "glActiveTexture");
  find(CreateShader, "glCreateShader");
  find(ShaderSource, "glShaderSource");
  find(CompileShader, "glCompileShader");
  find(GetShaderiv, "glGetShaderiv");
  find(GetShaderInfoLog, "glGetShaderInfoLog");
  find(CreateProgram, "glCreateProgram");
  find(AttachShader, "glAttachShader");
  find(LinkProgram, "glLinkProgram");
  find(GetProgramiv, "glGetProgramiv");
  find(GetProgramInfoLog, "glGetProgramInfoLog");
  find(UseProgram, "glUseProgram");
  find(GetUniformLocation, "glGetUniformLocation");
  find(Uniform1f, "glUniform1f");
  find(Uniform1i, "glUniform1i");
  find(GenVertexArrays, "glGenVertexArrays");
  find(BindVertexArray, "glBindVertexArray");
  find(DeleteVertexArrays, "glDeleteVertexArrays");
  find(GenBuffers, "glGenBuffers");
  find(BindBuffer, "glBindBuffer");
  find(BufferData, "glBufferData");
  find(DeleteBuffers, "glDeleteBuffers");
  find(EnableVertexAttribArray, "glEnableVertexAttribArray");
  find(VertexAttribPointer, "glVertexAttribPointer");
  find(VertexAttribIPointer, "glVertexAttribIPointer");
  find(GenFramebuffers, "glGenFramebuffers");
  find(BindFramebuffer, "glBindFramebuffer");
  find(FramebufferTexture2D, "glFramebufferTexture2D");
  find(GenRenderbuffers, "glGenRenderbuffers");
  find(BindRenderbuffer, "glBindRenderbuffer");
  find(RenderbufferStorage, "glRenderbufferStorage");
  find(FramebufferRenderbuffer, "glFramebufferRenderbuffer");
  find(CheckFramebufferStatus, "glCheckFramebufferStatus");
  find(ClearBufferuiv, "glClearBufferuiv");
  find(ClearBufferfv, "glClearBufferfv");
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
  gl_.Viewport(0, 0, size_, size_);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.Disable(GL_CULL_FACE);
  gl_.DepthFunc(GL_LESS);
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
  check("its set-up");
}

void OffscreenCanvas::Context::check_driver() {
  const auto text = [&](GLenum name) {
    const auto* value = reinterpret_cast<const char*>(gl_.GetString(name));
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
  gl_.GetIntegerv(GL_MAJOR_VERSION, &major);
  gl_.GetIntegerv(GL_MINOR_VERSION, &minor);
  if (10 * major + minor < 33) fail("OpenGL 3.3 is needed, not " + driver);
  gl_.GetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  if (size_ < 1 || size_ > largest) {
    fail("the driver draws images of 1 to " + std::to_string(largest) + " pixels a side, not " +
         std::to_string(size_));
  }
}

GLuint OffscreenCanvas::Context::shader(GLenum kind, const char* source) const {
  const GLuint result = gl_.CreateShader(kind);
  gl_.ShaderSource(result, 1, &source, nullptr);
  gl_.CompileShader(result);
  GLint done = GL_FALSE;
  gl_.GetShaderiv(result, GL_COMPILE_STATUS, &done);
  if (done == GL_TRUE) return result;
  std::array<char, 512> log = {};
  gl_.GetShaderInfoLog(result, GLsizei(log.size()), nullptr, log.data());
  fail(std::string("the driver does not take a shader: ") + log.data());
}

void OffscreenCanvas::Context::make_program() {
  program_ = gl_.CreateProgram();
  gl_.AttachShader(program_, shader(GL_VERTEX_SHADER, vertex_shader));
  gl_.AttachShader(program_, shader(GL_FRAGMENT_SHADER, fragment_shader));
  gl_.LinkProgram(program_);
  GLint done = GL_FALSE;
  gl_.GetProgramiv(program_, GL_LINK_STATUS, &done);
  if (done != GL_TRUE) {
    std::array<char, 512> log = {};
    gl_.GetProgramInfoLog(program_, GLsizei(log.size()), nullptr, log.data());
    fail(std::string("the driver does not link its shaders: ") + log.data());
  }
  gl_.UseProgram(program_);
}

GLuint OffscreenCanvas::Context::integer_texture() const {
  GLuint texture = 0;
  gl_.GenTextures(1, &texture);
  gl_.BindTexture(GL_TEXTURE_2D, texture);
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RG32UI, size_, size_, 0, GL_RG_INTEGER, GL_UNSIGNED_INT,
                 nullptr);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

GLuint OffscreenCanvas::Context::framebuffer(GLuint names) const {
  GLuint result = 0;
  gl_.GenFramebuffers(1, &result);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, result);
  gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, names, 0);
  gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
  if (gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    fail("the driver has no attachments of integers and depths of " + std::to_string(size_) +
         " pixels a side");
  }
  return result;
}

void OffscreenCanvas::Context::make_attachments() {
  gl_.ActiveTexture(GL_TEXTURE0);
  gl_.GenRenderbuffers(1, &depth_);
  gl_.BindRenderbuffer(GL_RENDERBUFFER, depth_);
  gl_.RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, size_, size_);
  for (std::size_t k = 0; k < 2; ++k) {
    names_[k] = integer_texture();
    framebuffers_[k] = framebuffer(names_[k]);
  }
  gl_.BindTexture(GL_TEXTURE_2D, 0);
}

void OffscreenCanvas::Context::check(const char* what) const {
  const GLenum error = gl_.GetError();
  if (error == GL_NO_ERROR) return;
  if (error == GL_OUT_OF_MEMORY) throw LimitExceeded("envelope images: out of memory");
  fail(std::string("the driver reports error ") + std::to_string(error) + " after " + what);
}

void OffscreenCanvas::Context::clear_triangles() {
  for (const Batch& batch : batches_) {
    gl_.DeleteVertexArrays(1, &batch.array);
    gl_.DeleteBuffers(1, &batch.buffer);
  }
  batches_.clear();
}

void OffscreenCanvas::Context::add(std::span<const Vertex> vertices) {
  if (vertices.empty()) return;
  Batch batch;
  batch.count = GLsizei(vertices.size());
  gl_.GenVertexArrays(1, &batch.array);
  gl_.BindVertexArray(batch.array);
  gl_.GenBuffers(1, &batch.buffer);
  gl_.BindBuffer(GL_ARRAY_BUFFER, batch.buffer);
  gl_.BufferData(GL_ARRAY_BUFFER, GLsizeiptr(vertices.size_bytes()), vertices.data(),
                 GL_STATIC_DRAW);
  const auto offset = [](std::size_t bytes) { return reinterpret_cast<const void*>(bytes); };
  constexpr GLsizei stride = sizeof(Vertex);
  const auto floats = [&](GLuint location, GLint count, std::size_t at) {
    gl_.EnableVertexAttribArray(location);
    gl_.VertexAttribPointer(location, count, GL_FLOAT, GL_FALSE, stride, offset(at));
  };
  floats(0, 2, offsetof(Vertex, x));
  floats(1, 3, offsetof(Vertex, point));
  floats(2, 2, offsetof(Vertex, b));
  floats(3, 3, offsetof(Vertex, bend));
  gl_.EnableVertexAttribArray(4);
  gl_.VertexAttribIPointer(4, 2, GL_UNSIGNED_INT, stride, offset(offsetof(Vertex, element)));
  batches_.push_back(batch);
  check("taking triangles");
}

OffscreenCanvas::Layer OffscreenCanvas::Context::draw(bool second) {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffers_[second ? 1 : 0]);
  // Not bound while it is drawn to.
  gl_.BindTexture(GL_TEXTURE_2D, second ? names_[0] : 0);
  const auto at = [&](const char* name) { return gl_.GetUniformLocation(program_, name); };
  gl_.Uniform1f(at("size"), float(size_));
  gl_.Uniform1f(at("pole"), float(pole));
  gl_.Uniform1f(at("extent"), float(extent));
  gl_.Uniform1f(at("reach"), float(reach));
  gl_.Uniform1i(at("second"), second ? 1 : 0);
  gl_.Uniform1i(at("first_names"), 0);
  const std::array<GLuint, 4> empty = {nothing, nothing, nothing, nothing};
  const GLfloat farthest = 1;
  gl_.ClearBufferuiv(GL_COLOR, 0, empty.data());
  gl_.ClearBufferfv(GL_DEPTH, 0, &farthest);
  for (const Batch& batch : batches_) {
    gl_.BindVertexArray(batch.array);
    gl_.DrawArrays(GL_TRIANGLES, 0, batch.count);
  }
  const auto side = std::size_t(size_);
  Layer layer{std::vector<Pixel>(side * side), std::vector<float>(side * side)};
  gl_.ReadBuffer(GL_COLOR_ATTACHMENT0);
  gl_.ReadPixels(0, 0, size_, size_, GL_RG_INTEGER, GL_UNSIGNED_INT, layer.pixels.data());
  gl_.ReadPixels(0, 0, size_, size_, GL_DEPTH_COMPONENT, GL_FLOAT, layer.depths.data());
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
