#include "taut/io/text/gunzip.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>
#include <new>

#include "taut/core/error.h"
#include "taut/io/text/text_scanner.h"

namespace taut {
namespace {

/// A stream of zlib's that decompresses data in memory, piece by piece.
class Inflater {
 public:
  Inflater(const std::string& name, std::string_view data) : name_(name), rest_(data) {
    constexpr int gzip_only = 16 + MAX_WBITS;
    if (inflateInit2(&stream_, gzip_only) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// Appends the next piece; false at the end of the last member.
  bool append_to(std::string& text) {
    feed();
    stream_.next_out = piece_.data();
    stream_.avail_out = uInt(piece_.size());
    const int state = inflate(&stream_, Z_NO_FLUSH);
    text.append(reinterpret_cast<const char*>(piece_.data()), piece_.size() - stream_.avail_out);
    if (state == Z_MEM_ERROR) throw std::bad_alloc();
    if (state == Z_STREAM_END) return next_member();
    const bool is_cut_off = stream_.avail_in == 0 && rest_.empty() && stream_.avail_out > 0;
    if (is_cut_off) throw IoError(name_ + ": is gzipped, and cut off");
    if (state != Z_OK) throw IoError(name_ + ": is gzipped, and damaged");
    return true;
  }

 private:
  void feed() {
    if (stream_.avail_in > 0) return;
    const std::size_t size = std::min(rest_.size(), std::size_t{std::numeric_limits<uInt>::max()});
    // The library does not write there.
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(rest_.data()));
    stream_.avail_in = uInt(size);
    rest_.remove_prefix(size);
  }
  /// Whether another member follows; what else does is passed over, as gzip does.
  bool next_member() {
    feed();
    const std::string_view left(reinterpret_cast<const char*>(stream_.next_in), stream_.avail_in);
    return is_gzipped(left) && inflateReset(&stream_) == Z_OK;
  }

  const std::string& name_;
  std::string_view rest_;
  z_stream stream_ = {};
  std::array<Bytef, 1 << 16> piece_;
};

}  // namespace

bool is_gzipped(std::string_view data) { return data.starts_with("\x1f\x8b\x08"); }

std::string gunzipped(const std::string& name, std::string_view data, const Progress& progress) {
  std::string text;
  Inflater inflater(name, data);
  progress.check();
  while (inflater.append_to(text)) {
    progress.check();
    if (text.size() > max_file_bytes) {
      throw LimitExceeded(name + ": holds more than " + std::to_string(max_file_bytes >> 20) +
                          " MiB, the most that is read");
    }
  }
  return text;
}

}  // namespace taut
