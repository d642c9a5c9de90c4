#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "judge.h"
#include "taut/io/text/read_options.h"

namespace taut_test {

/// A model from elsewhere on which hulls have failed.
struct Case {
  std::string file;  ///< in the folder of cases
  Expected expected = {};
  std::optional<taut::Scheme> scheme = {};

  /// The file without what follows its first dot; of cages for the scheme loop "_loop" behind it.
  std::string name() const;
};

struct CaseGroup {
  std::string name;
  std::vector<Case> cases;
};

/// Cases whose models are freeform, with what is known of their hulls. Volumes and mean widths have
/// been computed without Taut.
const std::vector<CaseGroup>& case_groups();

/// The folder "cases" beside the one that TAUT_MODELS names; none if there is no such folder.
std::optional<std::filesystem::path> folder_of_cases();

/// Reads the file twice: the model by Taut's reader, and the geometry itself.
Subject read_case(const std::filesystem::path& folder, const Case& from);

/// The surfaces, edges and vertices of all parts of a model document, without instances and loops,
/// straight from its text. @throws what the parser does
Shape shape_of_document(const std::filesystem::path& file);

}  // namespace taut_test
