#include "read_one.h"

#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <condition_variable>
#include <cstddef>
#include <ctime>
#include <mutex>
#include <stop_token>
#include <thread>

#include "taut/hull/convex_hull.h"
#include "taut/io/document/read_document.h"
#include "taut/io/document/read_hull.h"
#include "taut/io/document/write_document.h"
#include "taut/io/document/write_hull.h"
#include "taut/io/mesh/read_mesh.h"
#include "taut/io/model/read_model.h"
#include "taut/verify/verify_hull.h"
#include "tools/taut/directions.h"

namespace taut_test {
namespace {

using namespace taut;

/// Models beyond are not taken further than their reader.
constexpr std::size_t most_points = 2000;

/// Exact hulls of longer documents are not verified.
constexpr std::size_t longest_document = 200'000;

/// Within which a stop is heard.
#ifdef TAUT_SANITIZED
constexpr double longest_deafness = 2;
#else
constexpr double longest_deafness = 0.2;
#endif

/// A sentence and the longest path; longer is no message for a person.
constexpr std::size_t longest_message = 5000;

void require(bool holds, const std::string& what) {
  if (!holds) throw Finding(what);
}

void require_line(std::string_view text) {
  require(!text.empty() && text.size() <= longest_message,
          "a message of " + std::to_string(text.size()) + " characters");
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    require(code >= 0x20 && code != 0x7f,
            "a control character in the message: " + std::string(text));
  }
}

/// Seconds of the process.
double cpu_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

/// Collects warnings, and asks to stop after a while.
class Listener {
 public:
  Listener(Outcome& outcome, std::chrono::milliseconds limit)
      : outcome_(outcome),
        timer_([this, limit](const std::stop_token& done) { wait(done, limit); }) {}

  Progress progress() {
    Progress progress;
    progress.stop = stop_.get_token();
    progress.warn = [this](std::string_view code, std::string_view text) {
      require(!code.empty(), "a warning has no code");
      require_line(code);
      require_line(text);
      outcome_.warnings.emplace_back(text);
      require(outcome_.warnings.size() < 1000, "too many warnings");
    };
    progress.report = [](std::string_view, double share) {
      require(0 <= share && share <= 1, "a share of " + std::to_string(share) + " is done");
    };
    return progress;
  }

  /// @throws Finding if a stop was asked for, but not heard in time
  void check() const {
    if (!stop_.stop_requested()) return;
    const double deafness = cpu_seconds() - asked_;
    require(deafness <= longest_deafness, "deaf for " + std::to_string(deafness) + " s");
  }

 private:
  void wait(const std::stop_token& done, std::chrono::milliseconds limit) {
    std::unique_lock lock(mutex_);
    ended_.wait_for(lock, done, limit, [] { return false; });
    if (done.stop_requested()) return;
    asked_ = cpu_seconds();
    stop_.request_stop();
  }

  Outcome& outcome_;
  std::stop_source stop_;
  std::atomic<double> asked_ = 0;
  std::mutex mutex_;
  std::condition_variable_any ended_;
  std::jthread timer_;
};

std::size_t points_in(const Part& part) {
  std::size_t count = part.vertices().size();
  for (const std::vector<int>& polygon : part.polygons()) count += polygon.size();
  for (const Patch& patch : part.patches()) count += patch.bezier.points.size();
  for (const EdgePiece& piece : part.pieces()) count += piece.bezier.points.size();
  return count;
}

bool is_small(const Model& model) {
  std::size_t count = 0;
  for (const Part& part : model.parts()) count += 1 + points_in(part);
  for (const Instance& instance : model.instances()) {
    if (count > most_points) return false;
    count += 1 + points_in(model.parts()[static_cast<std::size_t>(instance.part)]);
  }
  return count <= most_points;
}

void check_document(const Model& model, Listener& listener) {
  for (const DocumentEncoding encoding : {DocumentEncoding::json, DocumentEncoding::cbor}) {
    std::string document;
    try {
      document = to_document(model, encoding);
    } catch (const InvalidInput&) {
      return;  // a trim loop's Euclidean coordinate overflows
    }
    Model back;
    ReadOptions options;
    options.progress = listener.progress();
    options.progress.warn = {};
    try {
      read_document("document", document, encoding, back, options);
    } catch (const Cancelled&) {
      throw;
    } catch (const Error& error) {
      throw Finding(std::string("the model's document is refused: ") + error.what());
    }
    require(to_document(back, encoding) == document, "the document of the document is another");
  }
}

void check_hull(const Model& model, Listener& listener) {
  HullOptions options;
  options.relative = 1e-2;
  options.max_vertices = 2000;
  options.threads = 1;
  options.progress = listener.progress();
  Hull hull;
  try {
    hull = convex_hull(model, options);
  } catch (const BackendError& error) {
    throw Finding(std::string("a library refused the hull: ") + error.what());
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    require_line(error.what());
    return;
  }
  require(hull.distance_bound >= 0 && std::isfinite(hull.distance_bound),
          "the bound of the hull's distance is " + std::to_string(hull.distance_bound));
  for (const auto vertex : hull.mesh.vertices()) {
    const dvec3 p = position(hull.mesh, vertex);
    require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z),
            "a vertex of the hull is not finite");
  }
  if (hull.kind != HullKind::solid) return;
  require(hull.mesh.n_faces() >= 4, "a solid hull has fewer than four faces");
  for (const auto edge : hull.mesh.halfedges()) {
    require(!hull.mesh.is_boundary(edge), "a solid hull is not closed");
  }
}

void check_model(const Model& model, Listener& listener) {
  if (!is_small(model)) return;
  check_document(model, listener);
  check_hull(model, listener);
}

void check_mesh(const PolygonMesh& mesh) {
  for (const dvec3& p : mesh.points) {
    require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z),
            "a point is not finite");
  }
  for (const std::vector<int>& polygon : mesh.polygons) {
    require(polygon.size() >= 3, "a polygon has fewer than three corners");
    for (const int v : polygon) {
      require(0 <= v && static_cast<std::size_t>(v) < mesh.points.size(),
              "a corner is out of range");
    }
  }
}

void check_exact_hull(const HullDocument& hull) {
  const std::string text = to_document(hull, DocumentEncoding::json);
  for (const DocumentEncoding encoding : {DocumentEncoding::json, DocumentEncoding::cbor}) {
    try {
      const HullDocument back = read_hull(to_document(hull, encoding), "document", encoding);
      require(to_document(back, DocumentEncoding::json) == text,
              "the document of the document is another");
    } catch (const Error& error) {
      throw Finding(std::string("the hull's document is refused: ") + error.what());
    }
  }
  if (text.size() > longest_document) return;
  static const Scene scene = [] {
    Model model;
    read_model("0 0 0\n1 0 0\n0 1 0\n0 0 1\n", "points", ".xyz", model);
    return Scene(std::move(model));
  }();
  VerifyOptions options;
  options.random_directions = 10;
  options.threads = 1;
  const HullVerification found = verify(hull, scene, options);
  require(found.tangency >= 0 && found.flatness >= 0 && found.off_source >= 0 &&
              found.model_outside >= 0 && found.hull_outside >= 0,
          "a measure of the verification is no number");
}

/// A file in memory.
class MemoryFile {
 public:
  explicit MemoryFile(std::string_view data) : descriptor_(memfd_create("directions", 0)) {
    if (descriptor_ < 0) throw std::runtime_error("no file in memory");
    while (!data.empty()) {
      const ssize_t count = write(descriptor_, data.data(), data.size());
      if (count < 0) throw std::runtime_error("a file in memory cannot be written");
      data.remove_prefix(static_cast<std::size_t>(count));
    }
  }
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string name() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

void read_and_check(const Reader& reader, std::string_view data, const std::string& name,
                    Listener& listener) {
  if (reader.kind == Reader::Kind::directions) {
    for (const dvec3& d : tool::read_directions(name, {})) {
      require(std::isfinite(d.x) && std::isfinite(d.y) && std::isfinite(d.z) && d != dvec3(0.0),
              "a direction is not valid");
    }
  } else if (reader.kind == Reader::Kind::hull) {
    check_exact_hull(read_hull(
        data, name, reader.format == ".hull.json" ? DocumentEncoding::json : DocumentEncoding::cbor,
        listener.progress()));
  } else if (reader.kind == Reader::Kind::mesh) {
    check_mesh(read_mesh(data, name, reader.format));
  } else {
    Model model;
    ReadOptions options;
    options.scheme = reader.scheme;
    options.progress = listener.progress();
    try {
      read_model(data, name, reader.format, model, options);
    } catch (const Error&) {
      require(model.parts().empty() && model.instances().empty(), "a file in error left a part");
      throw;
    }
    check_model(model, listener);
  }
}

}  // namespace

std::string Reader::corpus() const {
  if (scheme) return *scheme == Scheme::loop ? "loop" : "catmark";
  return format.substr(format.starts_with('.') ? 1 : 0);
}

const std::vector<Reader>& readers() {
  using enum Reader::Kind;
  static const std::vector<Reader> all = {{model, ".obj", Scheme::catmark},
                                          {model, ".obj", Scheme::loop},
                                          {model, ".bpt"},
                                          {model, ".mlp"},
                                          {model, ".obj"},
                                          {model, ".off"},
                                          {model, ".ply"},
                                          {model, ".stl"},
                                          {model, ".taut.cbor"},
                                          {model, ".taut.json"},
                                          {model, ".xyz"},
                                          {mesh, ".obj"},
                                          {mesh, ".off"},
                                          {mesh, ".ply"},
                                          {mesh, ".stl"},
                                          {directions, "directions"},
                                          {hull, ".hull.cbor"},
                                          {hull, ".hull.json"}};
  return all;
}

Outcome read_one(const Reader& reader, std::string_view data, const std::string& name,
                 std::chrono::milliseconds limit) {
  if (reader.kind == Reader::Kind::directions && !name.starts_with("/proc/")) {
    const MemoryFile file(data);
    return read_one(reader, data, file.name(), limit);
  }
  Outcome outcome;
  Listener listener(outcome, limit);
  try {
    read_and_check(reader, data, name, listener);
    outcome.accepted = true;
  } catch (const Cancelled&) {
    outcome.stopped = true;
  } catch (const Error& error) {
    outcome.error = error.what();
    require_line(outcome.error);
    require(outcome.error.starts_with(name + ":"),
            "the message does not begin with the file's name: " + outcome.error);
  } catch (const Finding&) {
    throw;
  } catch (const std::exception& error) {
    throw Finding(std::string("an exception that is not Taut's: ") + error.what());
  }
  listener.check();
  return outcome;
}

}  // namespace taut_test
