"""JSON Schema of the TOML files, as editors and validators read it."""

from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue
from pydantic_core import core_schema


class TidySchema(GenerateJsonSchema):
    """No titles that repeat a key, no null (TOML has none), of a docstring its first paragraph."""

    def field_title_should_be_set(self, schema: object) -> bool:  # noqa: ARG002  pydantic calls it
        """Leave out titles, which would repeat the keys."""
        return False

    def nullable_schema(self, schema: core_schema.NullableSchema) -> JsonSchemaValue:
        """Leave out null, which TOML has not."""
        return self.generate_inner(schema["schema"])

    def default_schema(self, schema: core_schema.WithDefaultSchema) -> JsonSchemaValue:
        """Leave out a default of null."""
        made = super().default_schema(schema)
        return {key: value for key, value in made.items() if (key, value) != ("default", None)}

    def model_schema(self, schema: core_schema.ModelSchema) -> JsonSchemaValue:
        """Describe a model by the first paragraph of its docstring."""
        made = super().model_schema(schema)
        return {**made, "description": made["description"].split("\n\n")[0]}
