#include "taut/io/read_model.h"

#include <string>
#include <utility>

#include "taut/io/formats.h"
#include "taut/io/model_document.h"
#include "taut/io/read_bpt.h"
#include "taut/io/read_obj.h"
#include "taut/io/text_scanner.h"

namespace taut {
namespace {

Part read_part(const std::filesystem::path& path, const Progress& progress) {
  const std::string kind = extension(path);
  if (kind == ".bpt") return read_bpt(path, progress);
  if (kind == ".obj") return read_obj(path, progress);
  std::string known;
  for (const Format& format : formats()) {
    if (format.reads_model) known += (known.empty() ? "" : ", ") + format.extension;
  }
  throw IoError(path.string() + ": no format of models has the extension \"" + kind +
                "\"; known are " + known);
}

}  // namespace

void read_model(const std::filesystem::path& path, Model& model, const ReadOptions& options) {
  if (const std::string kind = extension(path); kind == ".taut.json" || kind == ".taut.cbor") {
    const auto encoding = kind == ".taut.json" ? DocumentEncoding::json : DocumentEncoding::cbor;
    return read_document(path.string(), read_file(path), encoding, model, options);
  }
  Part part = read_part(path, options.progress);
  part.name = path.filename().string();
  options.progress.check();
  model.add_part(std::move(part), options.smooth_angle);
}

}  // namespace taut
