#pragma once

namespace taut {

/// What reader and writer of model documents share.
inline constexpr const char* document_format = "taut-model";
inline constexpr int document_version = 1;

/// Farthest that a homogeneous coordinate may be from the rounded product of the Euclidean one and
/// the weight, in doubles. The product of a rounded quotient is off by two at most, but where they
/// underflow.
inline constexpr int max_document_ulps = 2;

}  // namespace taut
