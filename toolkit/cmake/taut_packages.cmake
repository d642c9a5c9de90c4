# The Debian packages taut, libtaut and libtaut-dev, made by CPack.

set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME taut)
set(CPACK_PACKAGE_VERSION "${PROJECT_VERSION}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "") # each package has its own
set(CPACK_PACKAGE_VENDOR "The Taut authors")
set(CPACK_PACKAGE_CONTACT "The Taut authors <taut@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX "${CMAKE_INSTALL_PREFIX}")
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ
                                                GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL taut libtaut libtaut-dev)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY "=")
# Where dpkg-shlibdeps finds the libraries of this build.
get_property(layers GLOBAL PROPERTY TAUT_LAYERS)
list(TRANSFORM layers PREPEND "${PROJECT_BINARY_DIR}/toolkit/"
     OUTPUT_VARIABLE CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS)

set(about "Taut computes convex hulls of NURBS and Bezier surfaces and curves themselves,
not of a tessellation of them. Its meshes are closed, exactly convex and come
with a proven bound of their distance from the true hull.")

set(CPACK_DEBIAN_TAUT_PACKAGE_NAME taut)
set(CPACK_DEBIAN_TAUT_PACKAGE_SECTION math)
set(CPACK_DEBIAN_TAUT_PACKAGE_DEPENDS "libtaut (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_TAUT_DESCRIPTION "convex hulls of freeform models: command\n${about}")

set(CPACK_DEBIAN_LIBTAUT_PACKAGE_NAME libtaut)
set(CPACK_DEBIAN_LIBTAUT_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBTAUT_DESCRIPTION "convex hulls of freeform models: libraries\n${about}")
# Loaded when envelope images are drawn; all else works without it.
set(CPACK_DEBIAN_LIBTAUT_PACKAGE_RECOMMENDS libosmesa6)

set(CPACK_DEBIAN_LIBTAUT-DEV_PACKAGE_NAME libtaut-dev)
set(CPACK_DEBIAN_LIBTAUT-DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LIBTAUT-DEV_PACKAGE_DEPENDS
    "libtaut (= ${PROJECT_VERSION}), libglm-dev, libopenmesh-dev")
set(CPACK_DEBIAN_LIBTAUT-DEV_DESCRIPTION
    "convex hulls of freeform models: development files\n${about}")

file(WRITE "${PROJECT_BINARY_DIR}/installed/copyright" "\
Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: taut

Files: *
Copyright: The Taut authors
License: Apache-2.0
 Debian systems have the text in /usr/share/common-licenses/Apache-2.0.
")
foreach(package IN LISTS CPACK_COMPONENTS_ALL)
  install(FILES "${PROJECT_BINARY_DIR}/installed/copyright"
          DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/${package}" COMPONENT ${package})
endforeach()

include(CPack)
