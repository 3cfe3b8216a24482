from arena import Arena, Box, Wall

ROOM = Arena.create(
    name="one box",
    platform=[[(-2, -2), (2, -2), (2, 2), (-2, 2)]],
    walls=[Wall(start=(-3, -3), end=(3, -3), material="brick")],
    boxes=[Box(center=(0, 0), size=(1, 1), material="oak")],
)
