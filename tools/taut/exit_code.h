#pragma once

#include "taut/core/error.h"

namespace taut::tool {

/// What the command returns to the shell (contract: Exit codes).
enum class ExitCode : int {
  done = 0,
  check_failed = 1,
  wrong_usage = 2,
  io_error = 3,
  invalid_input = 4,
  not_converged = 5,
  limit_exceeded = 6,
  internal_error = 70,  ///< a mistake of ours; never on purpose
  interrupted = 130,    ///< by SIGINT
  terminated = 143,     ///< by SIGTERM
};

/// A mistake on the command line that shows only after it was parsed.
class UsageError : public Error {
 public:
  using Error::Error;
};

/// A check said no; the message says to what.
class CheckFailed : public Error {
 public:
  using Error::Error;
};

}  // namespace taut::tool
