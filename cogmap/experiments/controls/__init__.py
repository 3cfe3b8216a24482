"""Controls of the cells, one file each."""
