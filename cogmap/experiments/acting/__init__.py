"""Acting on the map: dreams, expectations, ways to goals, one file each."""
