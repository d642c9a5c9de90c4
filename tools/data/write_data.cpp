// Writes the models of the folder data/: write_data FOLDER

#include <cstdio>
#include <filesystem>

#include "data_models.h"
#include "taut/io/document/write_document.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: write_data FOLDER\n", stderr);
    return 2;
  }
  try {
    for (const auto& [name, model] : taut::shapes::data_models()) {
      taut::write_model(std::filesystem::path(argv[1]) / (name + ".taut.json"), model);
    }
  } catch (const taut::Error& error) {
    std::fprintf(stderr, "write_data: %s\n", error.what());
    return 3;
  }
  return 0;
}
