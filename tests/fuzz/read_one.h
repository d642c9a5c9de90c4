#pragma once

#include <chrono>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "taut/io/model/read_model.h"

namespace taut_test {

/// A reader and what it takes: the formats of models, meshes and exact hulls by their extensions
/// (".obj"), or the directions of `taut support`, whose format is "directions".
struct Reader {
  enum class Kind { model, mesh, directions, hull };
  Kind kind = Kind::model;
  std::string format;
  /// What polygons stand for, if that is said.
  std::optional<taut::Scheme> scheme = {};

  /// The folder of the corpus that holds its inputs: "obj", "taut.json"; of cages "catmark",
  /// "loop".
  std::string corpus() const;
};

/// All there are.
const std::vector<Reader>& readers();

/// What a reader must never do.
class Finding : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// What became of an input.
struct Outcome {
  bool accepted = false;
  bool stopped = false;  ///< the limit of time was met first
  std::string error;     ///< the message, where it was refused
  std::vector<std::string> warnings;
};

/// Gives one input to a reader and checks that it is refused by an error that a person can read,
/// in one line that begins with the name, or that the result holds together: a small model
/// survives its document in both encodings, and its hull is closed and finite; an exact hull
/// survives both encodings and can be verified. After `limit` all is asked to stop, and must
/// within 0.2 s of the process' time (under sanitizers ten times that).
///
/// `name` is what the input is called; the layers of a project are sought beside it. (What
/// directions are read from has a name of its own.)
/// @throws Finding
Outcome read_one(const Reader& reader, std::string_view data, const std::string& name,
                 std::chrono::milliseconds limit);

}  // namespace taut_test
