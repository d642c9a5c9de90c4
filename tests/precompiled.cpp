// The headers of precompiled.h are compiled with this file.
