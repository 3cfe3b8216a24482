"""What an explorer does with its map: imagine, expect and reach, one file each."""
