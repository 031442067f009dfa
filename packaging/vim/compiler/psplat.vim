" psplat.vim: :make checks the scene, and leads to what is wrong; gq lays out all of it.
if exists('current_compiler')
  finish
endif
let current_compiler = 'psplat'
CompilerSet makeprg=psplat\ check\ %:S
CompilerSet errorformat=%f:%l:%c:\ %trror:\ %m,%f:%l:%c:\ %tarning:\ %m,%-G%.%#

" The whole scene, as lines alone may mean something else; a faulty one stays as it is.
function! PsplatFormat() abort
  if mode() =~# '[iR]'
    return 1
  endif
  let lines = systemlist('psplat fmt -', getline(1, '$'))
  if v:shell_error
    echohl ErrorMsg | echomsg join(lines, ' ') | echohl None
    return 0
  endif
  call setline(1, lines)
  silent! call deletebufline('%', len(lines) + 1, '$')
  return 0
endfunction
setlocal formatexpr=PsplatFormat()
