# Debian packages by CPack, one a component. toolchains/packaging/package.sh sets PLIANT_DEB_ARCHITECTURE and PLIANT_DEB_DEPENDS
# and PLIANT_DEB_VIEWER_DEPENDS (what the programs are linked with), and adds what is common to all.
set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL runtime development lcmtypes)
if(TARGET pliant-view)
  list(APPEND CPACK_COMPONENTS_ALL viewer)
endif()
set(CPACK_SET_DESTDIR ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "Pliant maintainers <maintainers@users.noreply.h-seed-4b4319b5.example>")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE "")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(PLIANT_DEB_ARCHITECTURE "" CACHE STRING "Architecture of the packages; empty: this machine's")
set(PLIANT_DEB_DEPENDS "" CACHE STRING "What the program depends on, as in a package's control file")
set(PLIANT_DEB_VIEWER_DEPENDS "" CACHE STRING "What the viewer depends on, likewise")
if(PLIANT_DEB_ARCHITECTURE)
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE ${PLIANT_DEB_ARCHITECTURE})
endif()

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME pliant)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION misc)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS "${PLIANT_DEB_DEPENDS}")
# For pliant-multicast@.service; every Debian but a container has it.
set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS "iproute2")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SUGGESTS "pliant-viewer, pliant-lcmtypes, liblcm-bin")
set(CPACK_DEBIAN_RUNTIME_DESCRIPTION "Pliant finds a known object in the pictures of a depth camera and follows it
while it moves, bends and is squashed. It says where every point of the
object's model is, which parts move rigidly, which are deformed and which are
not seen, and publishes that over LCM.
.
This package has the program, a systemd service, and rules for the devices.")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA
  ${CMAKE_CURRENT_BINARY_DIR}/conffiles ${CMAKE_CURRENT_SOURCE_DIR}/debian/postinst
  ${CMAKE_CURRENT_SOURCE_DIR}/debian/prerm ${CMAKE_CURRENT_SOURCE_DIR}/debian/postrm)

# Everything below /etc is the user's.
file(GLOB sensors CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/config ${PROJECT_SOURCE_DIR}/config/sensors/*.toml)
list(TRANSFORM sensors PREPEND /etc/pliant/ OUTPUT_VARIABLE conffiles)
list(JOIN conffiles "\n" conffiles)
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/conffiles "/etc/pliant/pliant.toml\n${conffiles}\n")

# A package of its own: the tracker depends on no web server.
set(CPACK_DEBIAN_VIEWER_PACKAGE_NAME pliant-viewer)
set(CPACK_DEBIAN_VIEWER_PACKAGE_SECTION misc)
set(CPACK_DEBIAN_VIEWER_PACKAGE_DEPENDS "pliant (= ${PROJECT_VERSION}), ${PLIANT_DEB_VIEWER_DEPENDS}")
set(CPACK_DEBIAN_VIEWER_DESCRIPTION "What 'pliant view' runs: it listens to a tracker, here or on
another machine, and shows in a web browser the object in three dimensions, its
regions, what is deformed, the depth picture, and how the tracker fares. The
page comes with the package; nothing is fetched from anywhere.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libpliant-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libeigen3-dev (>= 3.4)")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "The tracking core of Pliant as a static library: it allocates no memory, uses
no clock, lock or file. With headers, a CMake package and a pkg-config file.")

set(CPACK_DEBIAN_LCMTYPES_PACKAGE_NAME pliant-lcmtypes)
set(CPACK_DEBIAN_LCMTYPES_PACKAGE_SECTION misc)
set(CPACK_DEBIAN_LCMTYPES_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_LCMTYPES_PACKAGE_SUGGESTS "liblcm-dev, liblcm-java, python3")
set(CPACK_DEBIAN_LCMTYPES_DESCRIPTION "The types that Pliant publishes, for subscribers: their definitions, and the
classes for C++ and Python.")
include(CPack)
