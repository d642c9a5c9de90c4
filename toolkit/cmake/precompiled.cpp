// The headers that toolkit/CMakeLists.txt names are compiled with this file.
