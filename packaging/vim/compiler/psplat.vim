" psplat.vim: :make checks the scene, and leads to what is wrong; gq lays it out.
if exists('current_compiler')
  finish
endif
let current_compiler = 'psplat'
CompilerSet makeprg=psplat\ check\ %:S
CompilerSet errorformat=%f:%l:%c:\ %trror:\ %m,%f:%l:%c:\ %tarning:\ %m,%-G%.%#
setlocal formatprg=psplat\ fmt\ -
