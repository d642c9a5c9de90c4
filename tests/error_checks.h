#pragma once

#include <gtest/gtest.h>

#include <exception>
#include <string>

#include "taut/core/error.h"

namespace taut_test {

/// The message of the `Error` that the call throws; a failure if it throws none or another.
template <class Error, class Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "another error: " << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return "";
}

/// The call throws InvalidInput, and its message says this.
template <class Call>
void expect_invalid(const Call& call, const std::string& part_of_message) {
  const std::string message = message_of<taut::InvalidInput>(call);
  EXPECT_NE(message.find(part_of_message), std::string::npos)
      << message << " instead of " << part_of_message;
}

}  // namespace taut_test
