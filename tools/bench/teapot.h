#pragma once

#include "taut/bounds/scene.h"
#include "taut/io/model/read_model.h"

/// The Utah teapot of the data folder.
inline taut::Model teapot() {
  taut::Model model;
  taut::read_model(TAUT_SOURCE_DIR "/data/teapot.bpt", model);
  return model;
}

inline const taut::Scene& teapot_scene() {
  static const taut::Scene scene(teapot(), {.threads = 1, .progress = {}});
  return scene;
}
