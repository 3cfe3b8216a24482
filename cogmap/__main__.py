"""`python -m cogmap`: the command line."""

from cogmap.cli import main

main()
