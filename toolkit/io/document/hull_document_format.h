#pragma once

#include <array>
#include <string_view>

namespace taut {

/// What reader and writer of hull documents share. Kinds are indexed by their enumerations.
inline constexpr std::string_view hull_format = "taut-hull";
inline constexpr int hull_version = 1;
inline constexpr std::array<std::string_view, 3> source_kind_names = {"face", "edge", "vertex"};
inline constexpr std::array<std::string_view, 3> face_kind_names = {"patch", "scroll", "facet"};
inline constexpr std::array<std::string_view, 4> curve_kind_names = {"bitangent", "edge", "join",
                                                                     "ruling"};

}  // namespace taut
