#include "taut/io/model/read_model.h"

#include <utility>

#include "taut/io/document/read_document.h"
#include "taut/io/model/read_part.h"
#include "taut/io/model/read_project.h"
#include "taut/io/text/formats.h"
#include "taut/io/text/gunzip.h"
#include "taut/io/text/text_scanner.h"

namespace taut {
namespace {

/// @throws IoError
void require_known(const std::string& name, const std::string& format) {
  if (const std::string advice = advice_on(format); !advice.empty()) {
    throw IoError(name + ": " + advice);
  }
  std::string known;
  for (const Format& f : formats()) {
    if (!f.reads_model) continue;
    if (f.extension == format) return;
    known += (known.empty() ? "" : ", ") + f.extension;
  }
  throw IoError(name + ": " +
                (format.empty() ? std::string("its name has no extension that tells the format")
                                : "no format of models has the extension " + in_quotes(format)) +
                "; known are " + known);
}

void add(FileContent content, const std::string& name, Model& model, const ReadOptions& options) {
  Part part = as_part(std::move(content), name, options);
  options.progress.check();
  try {
    model.add_part(std::move(part), options.smooth_angle, options.progress);
  } catch (const InvalidInput& error) {
    throw InvalidInput(name + ": " + error.what());
  } catch (const LimitExceeded& error) {
    throw LimitExceeded(name + ": " + error.what());
  }
}

}  // namespace

void read_model(const std::filesystem::path& path, Model& model, const ReadOptions& options) {
  const std::string name = path.string();
  const std::string format = input_extension(path);
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    throw IoError(name + ": is a folder; name a file in it");
  }
  require_known(name, format);
  std::string data = read_file(path, options.progress);
  if (!is_part_format(format)) return read_model(data, name, format, model, options);
  FileContent content = read_content(data, name, format, options);
  std::string().swap(data);
  add(std::move(content), name, model, options);
}

void read_model(std::string_view data, const std::string& name, const std::string& format,
                Model& model, const ReadOptions& options) {
  require_known(name, format);
  std::string unpacked;
  if (is_gzipped(data)) {
    unpacked = gunzipped(name, data, options.progress);
    data = unpacked;
  }
  if (is_part_format(format)) {
    add(read_content(data, name, format, options), name, model, options);
  } else if (format == ".mlp") {
    read_project(name, data, model, options);
  } else {
    const auto encoding = format == ".taut.json" ? DocumentEncoding::json : DocumentEncoding::cbor;
    read_document(name, data, encoding, model, options);
  }
}

}  // namespace taut
