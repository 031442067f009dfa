" psplat.vim: psplat's scenes are YAML; Photoshop's pictures end in .psd, too.
autocmd BufNewFile,BufRead *.psd if getline(1) !~# '^8BPS' | setfiletype yaml | compiler psplat | endif
