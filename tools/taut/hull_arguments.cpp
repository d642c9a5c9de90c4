#include "hull_arguments.h"

#include "taut/io/text/formats.h"

namespace taut::tool {

std::string HullArguments::format_of(const std::string& output) const {
  return output == "-" ? inputs.output_extension() : taut::extension(output);
}

}  // namespace taut::tool
