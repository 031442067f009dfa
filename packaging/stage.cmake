# stage.cmake: cpack runs it when the files of all components are in place, before it packs them. It makes of installed
# files what Debian's policy asks for: manual pages compressed (12.1), a copyright and changelogs for each package (12.5,
# 12.7), and binaries without symbols (10.1) and the compiler's remark.

set(source ${CMAKE_CURRENT_LIST_DIR})
find_program(GZIP gzip REQUIRED)
find_program(STRIP strip REQUIRED)

function(compress)
  execute_process(COMMAND ${GZIP} -9nf ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

function(strip folder)
  file(GLOB_RECURSE binaries ${folder}/bin/* ${folder}/lib/*.so ${folder}/lib/*.so.*.*)
  foreach(binary ${binaries})
    if(NOT IS_SYMLINK ${binary})
      execute_process(COMMAND ${STRIP} --strip-unneeded --remove-section=.comment ${binary}
                      COMMAND_ERROR_IS_FATAL ANY)
    endif()
  endforeach()
endfunction()

# Debian's form of a changelog, with one entry, which is about the packages themselves; its day is that of the first.
function(write_changelog file)
  file(WRITE ${file}
       "psplat (${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}) unstable; urgency=medium\n\n"
       "  * Packages made by CPack. changelog.gz has what is new in psplat.\n\n"
       " -- ${CPACK_PACKAGE_CONTACT}  Thu, 26 Nov 2026 00:00:00 +0000\n")
endfunction()

foreach(component ${CPACK_COMPONENTS_ALL})
  set(folder ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/${component})
  string(TOUPPER ${component} upper)
  set(documents ${folder}/usr/share/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  file(GLOB pages ${folder}/usr/share/man/man*/*.[1-9])
  if(pages)
    compress(${pages})
  endif()
  # Debian's zsh looks for completions of packages in a folder of its own.
  set(shell ${folder}/usr/share/zsh)
  if(EXISTS ${shell}/site-functions)
    file(RENAME ${shell}/site-functions ${shell}/vendor-completions)
  endif()
  strip(${folder}/usr)
  file(COPY ${source}/copyright DESTINATION ${documents})
  write_changelog(${documents}/changelog.Debian)
  configure_file(${source}/../CHANGELOG.md ${documents}/changelog COPYONLY)
  compress(${documents}/changelog.Debian ${documents}/changelog)
  if(component STREQUAL library)
    configure_file(${source}/lintian-overrides
                   ${folder}/usr/share/lintian/overrides/${CPACK_DEBIAN_${upper}_PACKAGE_NAME} COPYONLY)
  endif()
endforeach()
