#include "taut/core/error.h"

namespace taut {

std::string printable(std::string_view name, std::size_t longest) {
  const bool fits = name.size() <= longest;
  // UTF-8 is cut between characters: bytes 10xxxxxx continue one.
  while (!fits && longest > 0 && (static_cast<unsigned char>(name[longest]) & 0xC0U) == 0x80) {
    --longest;
  }
  std::string text(name.substr(0, longest));
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return fits ? text : text + "...";
}

}  // namespace taut
