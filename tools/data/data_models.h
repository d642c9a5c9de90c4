#pragma once

#include <string>
#include <vector>

#include "taut/surface/model.h"

namespace taut::shapes {

/// A model of the folder data/.
struct DataModel {
  std::string name;  ///< of the file, without ".taut.json"
  Model model;
};

/// All of them, sorted by name.
std::vector<DataModel> data_models();

}  // namespace taut::shapes
