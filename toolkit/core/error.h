#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace taut {

/// Base of everything that Taut throws; what() is one line for a person.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A name that someone else gave, fit for a message: control characters as '?', and what is longer
/// than so many bytes cut off.
std::string printable(std::string_view name, std::size_t longest = 80);

/// The caller's mistake: numbers that are no valid geometry (NaN, a negative weight, a decreasing
/// knot vector, an index out of range). The message names the object and the number at fault.
class InvalidInput : public Error {
 public:
  using Error::Error;
};

/// A file that cannot be read or written, or is not what its format says.
/// The message begins with the file's name and, where known, the line or byte: "FILE:LINE: ...".
class IoError : public Error {
 public:
  using Error::Error;
};

/// A tolerance was not reached; `reached` is what was, in model units.
class NotConverged : public Error {
 public:
  /// The message and what was reached, in model units.
  NotConverged(const std::string& message, double reached_tolerance)
      : Error(message), reached(reached_tolerance) {}
  double reached;  ///< in model units
};

/// A third-party library failed at what it was asked for.
class BackendError : public Error {
 public:
  using Error::Error;
};

/// The caller asked to stop (see progress.h).
class Cancelled : public Error {
 public:
  Cancelled() : Error("cancelled") {}
};

/// A limit of time or memory was met before the work was done.
class LimitExceeded : public Error {
 public:
  using Error::Error;
};

/// The same, of the limits that an operation was given (limits.h); the message names the limit.
class LimitMet : public LimitExceeded {
 public:
  using LimitExceeded::LimitExceeded;
};

}  // namespace taut
