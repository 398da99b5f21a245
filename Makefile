# make demo · make test · make bench
