"""Stages of a suite on other machines, by Dask: ``unshade run SUITE -o RUN --cluster ADDRESS``.

The output of a stage goes into a store that all machines share, under the hash of its content; Dask carries
hashes alone. A stage whose output is in the store is never done again, whoever asks for it.
"""
