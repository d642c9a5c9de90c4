#include "output.h"

#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "exit_code.h"
#include "taut/io/model/write_project.h"
#include "taut/io/text/formats.h"
#include "taut/io/text/whole_file.h"
#include "text.h"

namespace taut::tool {
namespace {

namespace fs = std::filesystem;

void check_extension(const std::string& file, const std::string& stdout_format) {
  if (file == "-" && stdout_format.empty()) {
    throw UsageError("standard output needs its format, such as --to ply");
  }
  const std::string wanted = file == "-" ? stdout_format : extension(file);
  std::vector<std::string> known;
  for (const Format& format : formats()) {
    if (!format.writes_mesh && !format.writes_hull) continue;
    if (format.extension == wanted && file == "-" && wanted == ".mlp") {
      throw UsageError("a project is several files, which standard output cannot hold");
    }
    if (format.extension == wanted) return;
    known.push_back(format.extension);
  }
  throw UsageError(file + ": " +
                   (wanted.empty() ? "no extension names the format"
                                   : "no format of hulls has the extension " + wanted) +
                   "; known are " + joined(known, " "));
}

/// Why the file cannot be written; empty if nothing shows that.
std::string fault_of_place(const std::string& file) {
  const auto fault = [&](const std::string& reason) {
    return file + ": cannot be written: " + reason;
  };
  const fs::path path(file);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::error_code error;
  if (!fs::exists(folder, error)) return fault("there is no folder " + folder.string());
  if (!fs::is_directory(folder, error)) return fault(folder.string() + " is no folder");
  if (fs::is_directory(path, error)) return fault("it is a folder");
  const bool there = fs::exists(path, error);
  if (there && access(file.c_str(), W_OK) != 0) return fault(system_reason());
  // A file is written beside its place first, a pipe or device in its place.
  const bool beside = !there || fs::is_regular_file(path, error);
  if (beside && access(folder.c_str(), W_OK | X_OK) != 0) {
    return fault(folder.string() + ": " + system_reason());
  }
  return {};
}

/// The files that an output is written as.
std::vector<std::string> files_of(const std::string& output) {
  if (output == "-") return {};
  if (extension(output) != ".mlp") return {output};
  std::vector<std::string> files;
  for (const fs::path& layer : project_files(output)) files.push_back(layer.string());
  return files;
}

/// The first fault of its files.
std::string fault_of_output(const std::string& output) {
  for (const std::string& file : files_of(output)) {
    std::string fault = fault_of_place(file);
    if (!fault.empty()) return fault;
  }
  return {};
}

bool same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  const fs::path first = fs::weakly_canonical(fs::absolute(a, error), error);
  const fs::path second = fs::weakly_canonical(fs::absolute(b, error), error);
  return !first.empty() && first == second;
}

/// @throws UsageError if a file is named twice or is also an input
void check_distinct(const std::vector<std::string>& outputs,
                    const std::vector<std::string>& inputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (same_file(outputs[i], outputs[k])) {
        throw UsageError(outputs[i] + ": is named twice as an output");
      }
    }
    for (const std::string& input : inputs) {
      if (same_file(outputs[i], input)) throw UsageError(outputs[i] + ": is an input");
    }
  }
}

void write_whole(std::FILE* file, const std::string& path, std::string_view text) {
  const bool written =
      std::fwrite(text.data(), 1, text.size(), file) == text.size() && std::fflush(file) == 0;
  if (!written) throw IoError(path + ": cannot be written: " + system_reason());
}

}  // namespace

OutputPlaces check_outputs(const std::vector<std::string>& hulls, const std::string& stdout_format,
                           const std::string& report, const std::vector<std::string>& inputs) {
  for (const std::string& file : hulls) check_extension(file, stdout_format);
  std::vector<std::string> outputs;
  for (const std::string& file : hulls) {
    for (std::string& own : files_of(file)) outputs.push_back(std::move(own));
  }
  if (!report.empty() && report != "-") outputs.push_back(report);
  check_distinct(outputs, inputs);

  OutputPlaces places;
  std::string first_fault;
  bool any = report == "-";
  const auto check = [&](const std::string& output) {
    std::string fault = fault_of_output(output);
    if (fault.empty()) any = true;
    if (first_fault.empty()) first_fault = fault;
    return fault;
  };
  for (const std::string& file : hulls) places.hulls.push_back(check(file));
  if (!report.empty() && report != "-") places.report = check(report);
  if (!any && !first_fault.empty()) throw IoError(first_fault);
  return places;
}

void write_text(const std::string& path, std::string_view text) {
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_regular_file(path, error)) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "wb"),
                                                               &std::fclose);
    if (!file) throw IoError(path + ": cannot be written: " + system_reason());
    write_whole(file.get(), path, text);
    return;
  }
  write_whole_file(path, text);
}

void write_stdout(std::string_view text) { write_whole(stdout, "standard output", text); }

}  // namespace taut::tool
