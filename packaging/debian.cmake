# Debian packages: ninja man_pages && cpack in the build folder leaves nextview (programs, scenes, message types) and
# nextview-dev (headers, archives, find_package).
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME nextview)
set(CPACK_PACKAGE_CONTACT "The nextview project")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "next-best-view planning: a robot recovers an indoor scene by itself")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL runtime development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME nextview)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
# The recorder.
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS liblcm-bin)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME nextview-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "libeigen3-dev, libfmt-dev, libhwy-dev, libsodium-dev, libxxhash-dev, nlohmann-json3-dev, pkg-config")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS
    "liblcm-dev, libglib2.0-dev, libcli11-dev, libassimp-dev, libembree-dev, coinor-libclp-dev, libcairo2-dev")
include(CPack)
