#pragma once

namespace taut {

/// The two encodings of a document: `.json` and `.cbor` (RFC 8949).
enum class DocumentEncoding { json, cbor };

}  // namespace taut
