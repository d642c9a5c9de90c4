#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "taut/core/error.h"
#include "taut/core/progress.h"

namespace taut {

/// Files beyond this are refused before any of them is read: far above every real text model, and
/// line and byte numbers as well as vertex indices stay small.
inline constexpr std::size_t max_file_bytes = std::size_t{1} << 31;

/// The whole file, without its compression if it is gzipped.
/// @throws IoError if it cannot be read or is damaged, LimitExceeded above max_file_bytes;
/// Cancelled, LimitMet
std::string read_file(const std::filesystem::path& path, const Progress& progress = {});

/// A word of a text file and the line that it begins on.
struct Word {
  std::string_view text;
  long line = 0;
};

/// Splits text into words, keeps count of lines, and turns words into numbers, independently of
/// the locale. What is wrong is thrown as an error that begins with "FILE:LINE: ".
///
/// Words stand between white space; '#' where a word would begin starts a comment up to the end of
/// the line. Lines end in "\n", "\r\n" or "\r". A byte order mark at the beginning is passed over.
/// The text must outlive the scanner and its words.
class TextScanner {
 public:
  TextScanner(std::string file, std::string_view text);

  const std::string& file() const { return file_; }
  /// The line of what comes next, from 1.
  long line() const { return line_; }
  /// Offset of what comes next.
  std::size_t offset() const { return at_; }
  /// Bytes from there to the end.
  std::size_t bytes_left() const { return text_.size() - at_; }

  /// Nothing but white space and comments is left.
  bool at_end();
  /// The next word, on this or a later line; `expected` says what it should be: "a coordinate".
  /// @throws IoError at the end of the file
  Word next(std::string_view expected);
  double next_number(std::string_view expected);
  long next_integer(std::string_view expected) { return integer(next(expected), expected); }
  /// Passes over what is left of the line and its end.
  void skip_line();
  /// The rest of the line, without its end, with comments; then passes over it.
  std::string_view rest_of_line();
  /// The words of the next line that has any, of several lines where a backslash joins them.
  /// False at the end of the file.
  bool next_statement(std::vector<Word>& words);

  /// The finite double that is nearest to the word; too small ones are zero.
  /// @throws IoError if the word is no number, InvalidInput if it is not finite or overflows
  double number(const Word& word, std::string_view expected) const;
  /// @throws IoError if the word is no integer, InvalidInput if it overflows
  long integer(const Word& word, std::string_view expected) const;
  /// A number of things that follow, each in at least `bytes` bytes: "patches".
  /// @throws InvalidInput if it is negative or more than what is left of the file can hold
  std::size_t count(const Word& word, std::size_t bytes, std::string_view things) const;

  /// The file is not what its format says. @throws IoError
  [[noreturn]] void fail(long line, std::string_view what) const;
  /// A number is no valid geometry. @throws InvalidInput
  [[noreturn]] void refuse(long line, std::string_view what) const;
  /// Calls what knows nothing of files, and gives its InvalidInput the place.
  template <class Call>
  void placed(long line, const Call& call) const {
    try {
      call();
    } catch (const InvalidInput& error) {
      refuse(line, error.what());
    }
  }

 private:
  std::size_t line_end_at(std::size_t i) const;
  void skip_space(bool over_lines, bool continuation);
  Word read_word(bool continuation);

  std::string file_;
  std::string_view text_;
  std::size_t at_ = 0;
  long line_ = 1;
};

/// The word in quotation marks, fit for a message: shortened, and unprintable bytes as '?'.
std::string in_quotes(std::string_view word);

/// The shortest decimal form that reads back as the same double.
std::string shortest(double value);

}  // namespace taut
